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
  const answer = await fetch(`surface/${scene}/${region}`);
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
