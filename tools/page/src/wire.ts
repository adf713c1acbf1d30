// The server's messages, and the connection to it.

export type Vector = [number, number, number];

export interface RegionWords {
  name: string;
  color: string | null;
  wall: string;
  content: string;
  reach: string;
}

export interface TransitionRow {
  from: number;
  to: number;
  port: number | null;
  when: string[];
}

export interface SceneWords {
  number: number;
  file: string;
  unit: { name: string; meters: number };
  box: { lo: Vector; hi: Vector };
  start: Vector;
  start_region: number;
  regions: RegionWords[];
  ports: string[];
  transitions: TransitionRow[];
  mode: "hand" | "device" | "replay";
  device: string;
  max_force?: number; // [N] of the device
  rate?: number;
  rows: number | null;
  overview?: number[];
}

export interface Entry {
  tick: number;
  from: number;
  to: number;
  port: number | null;
  force: number;
}

export interface Hole {
  port: number;
  point: Vector;
  normal: Vector;
  radius: number;
}

export interface Tick {
  n: number;
  t: number;
  hip: (number | null)[]; // null: not a number
  proxy: Vector;
  force: Vector;
  told: Vector | null;
  region: number;
  contact: boolean;
  settled: boolean;
  strongest: number;
  work: number;
  ns: number;
  worst_ns: number;
  late: number;
  passed: number[];
  holes: Hole[];
  shaft: Vector | null; // where it first went in; null: it is free
  content: string;
  wall: string;
  entries: Entry[];
}

/** What the scene's file holds, and what became of it. */
export interface SceneText {
  edit: number;
  state: "felt" | "compiling" | "refused" | "recorded";
  text: string;
  line: number | null; // of the problem, from 1
  problem: string | null;
  hint: string | null;
}

export interface Snapshot {
  scene: number;
  edit: number; // counts changes of SceneText
  surfaces: number;
  ports: boolean; // that on surfaces are known
  slices: boolean; // of a scan are there
  steers: boolean;
  steered: boolean;
  pages: number;
  row?: number;
  tick?: Tick;
}

/** A surface as the server sends it: see tools/src/view/surface_net.h. */
export interface Surface {
  points: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
}

export async function fetchScene(): Promise<SceneWords> {
  const answer = await fetch("scene.json");
  if (!answer.ok) throw new Error(await answer.text());
  return (await answer.json()) as SceneWords;
}

export async function fetchText(): Promise<SceneText> {
  const answer = await fetch("text.json");
  if (!answer.ok) throw new Error(await answer.text());
  return (await answer.json()) as SceneText;
}

/** Null for a region without a surface. */
export async function fetchSurface(scene: number, region: number): Promise<Surface | null> {
  return await fetchTriangles(`surface/${scene}/${region}`);
}

/** The part of surfaces that is a port; null for a port that is on none. */
export async function fetchPort(scene: number, port: number): Promise<Surface | null> {
  return await fetchTriangles(`port/${scene}/${port}`);
}

async function fetchTriangles(path: string): Promise<Surface | null> {
  const answer = await fetch(path);
  if (!answer.ok) return null;
  const bytes = await answer.arrayBuffer();
  const head = new DataView(bytes);
  const points = head.getUint32(4, true);
  const triangles = head.getUint32(8, true);
  if (triangles === 0) return null;
  return {
    points: new Float32Array(bytes, 12, 3 * points),
    normals: new Float32Array(bytes, 12 + 12 * points, 3 * points),
    indices: new Uint32Array(bytes, 12 + 24 * points, 3 * triangles),
  };
}

/** Where the slices of a scan are: see tools/src/view/gray_slices.h. */
export interface SliceWords {
  file: string;
  box: { lo: Vector; hi: Vector };
  counts: Vector;
}

export async function fetchSlices(scene: number): Promise<SliceWords | null> {
  const answer = await fetch(`slices/${scene}`);
  return answer.ok ? ((await answer.json()) as SliceWords) : null;
}

/** Null for a slice that is not there. Transparent where the scan has no value, and where it is black, as around a body. */
export async function fetchSlice(scene: number, axis: number, index: number): Promise<ImageData | null> {
  const answer = await fetch(`slice/${scene}/${axis}/${index}`);
  if (!answer.ok) return null;
  const bytes = await answer.arrayBuffer();
  const head = new DataView(bytes);
  const shades = new Uint8Array(bytes, 12);
  const image = new ImageData(head.getUint32(4, true), head.getUint32(8, true));
  shades.forEach((shade, i) => {
    const gray = Math.max(shade - 1, 0);
    image.data.set([gray, gray, gray, gray === 0 ? 0 : 255], 4 * i);
  });
  return image;
}

/** Calls `onSnapshot` for each message, and `onEnd` when the server is permanently gone. */
export class Line {
  private readonly socket: WebSocket;

  constructor(onSnapshot: (snapshot: Snapshot) => void, onEnd: () => void) {
    const address = new URL("live", location.href);
    address.protocol = "ws:";
    this.socket = new WebSocket(address);
    this.socket.onmessage = (event) => {
      onSnapshot(JSON.parse(event.data as string) as Snapshot);
      // The next one comes only after this, so that a slow page shows the present, not the past.
      this.say('{"seen":true}');
    };
    this.socket.onclose = onEnd;
  }

  steer(wanted: boolean): void {
    this.say(JSON.stringify({ steer: wanted }));
  }
  to(place: Vector): void {
    this.say(JSON.stringify({ to: place }));
  }
  row(row: number): void {
    this.say(JSON.stringify({ row }));
  }

  private say(text: string): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(text);
  }
}
