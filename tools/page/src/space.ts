// The scene in space: surfaces, the cut, the probe and its trail.

import * as THREE from "three";
import { colorOfShare } from "./colors";
import { Detail } from "./detail";
import type { SceneWords, Surface, Tick, Vector } from "./wire";

export type Cut = "off" | "x" | "y" | "z" | "view";

const trailLength = 1500; // points
const fullForce = 3; // [N] at the end of the trail's color scale
const up = new THREE.Vector3(0, 0, 1);

const vectorOf = (v: Vector): THREE.Vector3 => new THREE.Vector3(v[0], v[1], v[2]);

/** The color in a custom property of the style sheet. */
export const styleColor = (name: string): THREE.Color =>
  new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());

export class Space {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(35, 1, 1e-4, 100);
  private readonly layers = new THREE.Group();
  private readonly meshes = new Map<number, THREE.Mesh>();
  /** Surfaces of the scene before an edit, by their layers' names: shown until the new ones are here. */
  private readonly former = new Map<string, THREE.Mesh>();
  private readonly names = new Map<number, string>();
  private readonly hip: THREE.Mesh;
  private readonly proxy: THREE.Mesh;
  private readonly told: THREE.Mesh;
  private readonly arrow = new THREE.Group(); // along y, 1 long
  private readonly link: THREE.Line;
  private readonly trail: THREE.Points;
  private readonly trailPlaces = new Float32Array(3 * trailLength);
  private readonly trailColors = new Float32Array(3 * trailLength);
  private trailCount = 0;
  private readonly plane = new THREE.Plane(new THREE.Vector3(0, 1, 0), 0);
  /** What layers are clipped by: the cut's plane, or nothing. */
  readonly clipping: THREE.Plane[] = [];
  cut: Cut = "off";
  private readonly probe = new THREE.Vector3();
  private center = new THREE.Vector3();
  private diagonal = 1;
  private distance = 1;
  private azimuth = -Math.PI / 2 + 0.5;
  private elevation = 0.42;
  /** Number of frames in which the picture was up to date. */
  frames = 0;
  /** Number of frames that were drawn, because something in them had changed. */
  drawn = 0;
  private isStale = true;
  readonly detail = new Detail();
  private felt: { tick: Tick; marks: string } | null = null;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.localClippingEnabled = true;
    this.scene.background = styleColor("--ground");
    this.scene.add(this.layers, new THREE.HemisphereLight(0xffffff, 0x8090a0, 2.2));
    const lamp = new THREE.DirectionalLight(0xffffff, 1.8);
    lamp.position.set(-0.4, -0.8, 1);
    this.scene.add(lamp);

    // Marks count as transparent, so that they are drawn after all layers, including translucent
    // ones.
    const ball = new THREE.SphereGeometry(1, 24, 16);
    const mark = (name: string) =>
      new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ color: styleColor(name), depthTest: false, transparent: true }));
    this.hip = mark("--hip");
    this.proxy = mark("--proxy");
    this.told = mark("--told");
    this.hip.renderOrder = 5;
    this.proxy.renderOrder = 6;
    this.told.renderOrder = 4;
    // A rod and not a line, which is one pixel wide whatever is asked for.
    const yellow = new THREE.MeshBasicMaterial({ color: styleColor("--force"), depthTest: false, transparent: true });
    for (const part of [new THREE.CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0), new THREE.ConeGeometry(3, 1, 16).translate(0, 0.5, 0)]) {
      const mesh = new THREE.Mesh(part, yellow);
      mesh.renderOrder = 7;
      this.arrow.add(mesh);
    }
    this.link = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3()]),
      new THREE.LineBasicMaterial({ color: styleColor("--told"), depthTest: false, transparent: true, opacity: 0.6 }),
    );
    this.link.renderOrder = 3;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(this.trailPlaces, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(this.trailColors, 3));
    geometry.setDrawRange(0, 0);
    this.trail = new THREE.Points(
      geometry,
      new THREE.PointsMaterial({
        size: 4,
        sizeAttenuation: false,
        vertexColors: true,
        depthTest: false,
        transparent: true,
      }),
    );
    this.trail.frustumCulled = false;
    this.trail.renderOrder = 2;
    this.scene.add(this.hip, this.proxy, this.told, this.arrow, this.link, this.trail);
  }

  /** Something that the picture shows has changed. */
  changed(): void {
    this.isStale = true;
  }

  /** Shows the box of `words`. Surfaces of the scene before stay until complete(). */
  begin(words: SceneWords, keepsView: boolean): void {
    this.complete();
    for (const [region, mesh] of this.meshes) this.former.set(this.names.get(region)!, mesh);
    this.meshes.clear();
    words.regions.forEach((region, index) => this.names.set(index, region.name));
    const lo = vectorOf(words.box.lo);
    const hi = vectorOf(words.box.hi);
    this.diagonal = lo.distanceTo(hi);
    if (!keepsView) {
      this.center = lo.add(hi).multiplyScalar(0.5);
      this.distance = 1.75 * this.diagonal;
    }
    const size = 0.011 * this.diagonal;
    this.hip.scale.setScalar(0.8 * size);
    this.proxy.scale.setScalar(size);
    this.told.scale.setScalar(0.45 * size);
  }

  addSurface(region: number, surface: Surface, color: string, opacity: number, visible: boolean): void {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(surface.points, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(surface.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(surface.indices, 1));
    const material = new THREE.MeshLambertMaterial({
      color,
      side: THREE.DoubleSide,
      clippingPlanes: this.clipping,
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.userData.triangles = surface.indices.length / 3;
    // Inner surfaces are drawn first.
    mesh.renderOrder = -region;
    this.dropFormer(this.names.get(region)!);
    this.meshes.set(region, mesh);
    this.layers.add(mesh);
    this.detail.add(mesh);
    this.look(region, opacity, visible);
  }

  /** Number of triangles of a region's surface; 0: it has none, or none yet. */
  triangles(region: number): number {
    return (this.meshes.get(region)?.userData.triangles as number | undefined) ?? 0;
  }

  /** All surfaces of the present scene are here. */
  complete(): void {
    for (const name of [...this.former.keys()]) this.dropFormer(name);
    this.changed();
  }

  private dropFormer(name: string): void {
    const mesh = this.former.get(name);
    if (mesh === undefined) return;
    this.former.delete(name);
    this.layers.remove(mesh);
    this.detail.remove(mesh);
    mesh.geometry.dispose();
    (mesh.material as THREE.Material).dispose();
  }

  look(region: number, opacity: number, visible: boolean): void {
    const mesh = this.meshes.get(region);
    if (mesh === undefined) return;
    const material = mesh.material as THREE.MeshLambertMaterial;
    const isClear = opacity < 1;
    if (material.transparent !== isClear) material.needsUpdate = true;
    material.transparent = isClear;
    material.depthWrite = !isClear;
    material.opacity = opacity;
    mesh.visible = visible && opacity > 0;
    this.changed();
  }

  setCut(cut: Cut): void {
    this.cut = cut;
    this.clipping.length = 0;
    if (cut !== "off") this.clipping.push(this.plane);
    this.changed();
  }

  add(part: THREE.Object3D): void {
    this.scene.add(part);
    this.changed();
  }
  remove(part: THREE.Object3D): void {
    this.scene.remove(part);
    this.changed();
  }

  /** Whether a picture of `tick` would look like the one of the tick before. */
  private looksAlike(tick: Tick, marks: string): boolean {
    if (this.felt === null || this.felt.marks !== marks) return false;
    const before = this.felt.tick;
    const apart = (a: readonly (number | null)[] | null, b: readonly (number | null)[] | null, most: number) =>
      a === null || b === null ? a !== b : a.some((v, i) => Math.abs(v! - b[i]!) > most);
    const dot = 1e-4 * this.distance; // [m] a tenth of a pixel
    return !(
      apart(before.hip, tick.hip, dot) ||
      apart(before.proxy, tick.proxy, dot) ||
      apart(before.told, tick.told, dot) ||
      apart(before.force, tick.force, 2e-3)
    );
  }

  showTick(tick: Tick): void {
    if (tick.hip.includes(null)) return;
    const marks = JSON.stringify([tick.holes, tick.shaft]);
    if (this.looksAlike(tick, marks)) return;
    this.felt = { tick, marks };
    this.changed();
    this.hip.position.set(...(tick.hip as Vector));
    this.proxy.position.set(...tick.proxy);
    this.probe.copy(this.proxy.position);
    const force = vectorOf(tick.force);
    const strength = force.length();
    this.arrow.visible = strength > 1e-3;
    if (this.arrow.visible) {
      const length = this.diagonal * Math.min(0.02 + 0.06 * strength, 0.4);
      this.arrow.position.copy(this.proxy.position);
      this.arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), force.divideScalar(strength));
      const [rod, head] = this.arrow.children as [THREE.Mesh, THREE.Mesh];
      const width = 0.0025 * this.diagonal;
      const point = Math.min(0.3 * length, 0.018 * this.diagonal);
      rod.scale.set(width, length - point, width);
      head.scale.set(width, point, width);
      head.position.y = length - point;
    }
    this.told.visible = tick.told !== null;
    this.link.visible = this.told.visible;
    if (tick.told !== null) {
      this.told.position.set(...tick.told);
      const ends = this.link.geometry.getAttribute("position") as THREE.BufferAttribute;
      ends.setXYZ(0, ...(tick.hip as Vector));
      ends.setXYZ(1, ...tick.told);
      ends.needsUpdate = true;
      this.link.geometry.computeBoundingSphere();
    }
    this.addToTrail(strength);
  }

  clearTrail(): void {
    this.trailCount = 0;
    this.trail.geometry.setDrawRange(0, 0);
    this.changed();
  }

  private addToTrail(strength: number): void {
    const at = this.probe;
    const last = (this.trailCount + trailLength - 1) % trailLength;
    if (this.trailCount > 0) {
      const far = Math.hypot(
        at.x - this.trailPlaces[3 * last]!,
        at.y - this.trailPlaces[3 * last + 1]!,
        at.z - this.trailPlaces[3 * last + 2]!,
      );
      if (far < 2e-3 * this.diagonal) return;
    }
    const slot = this.trailCount % trailLength;
    at.toArray(this.trailPlaces, 3 * slot);
    const color = new THREE.Color().setRGB(...colorOfShare(strength / fullForce), THREE.SRGBColorSpace);
    color.toArray(this.trailColors, 3 * slot);
    ++this.trailCount;
    const geometry = this.trail.geometry;
    geometry.setDrawRange(0, Math.min(this.trailCount, trailLength));
    (geometry.getAttribute("position") as THREE.BufferAttribute).needsUpdate = true;
    (geometry.getAttribute("color") as THREE.BufferAttribute).needsUpdate = true;
  }

  turn(azimuth: number, elevation: number): void {
    if (azimuth === 0 && elevation === 0) return;
    this.azimuth += azimuth;
    this.elevation = Math.min(Math.max(this.elevation + elevation, -1.5), 1.5);
    this.changed();
  }
  zoom(factor: number): void {
    this.distance = Math.min(Math.max(this.distance * factor, 0.1 * this.diagonal), 8 * this.diagonal);
    this.changed();
  }

  /** `place` moved to the right, up and away from the viewer, by shares of the view's height. */
  moved(place: Vector, right: number, upward: number, away: number): Vector {
    const from = vectorOf(place);
    const across = 2 * Math.tan((this.camera.fov * Math.PI) / 360) * from.distanceTo(this.camera.position);
    const axes = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()] as const;
    this.camera.matrixWorld.extractBasis(...axes);
    from.addScaledVector(axes[0], across * right);
    from.addScaledVector(axes[1], across * upward);
    from.addScaledVector(axes[2], -across * away);
    return [from.x, from.y, from.z];
  }

  draw(): void {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(window.devicePixelRatio, 2);
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.changed();
    }
    ++this.frames;
    if (!this.detail.isDue(performance.now(), this.isStale)) return;
    this.isStale = false;
    this.camera.near = 0.01 * this.distance;
    this.camera.far = 10 * this.distance + 4 * this.diagonal;
    this.camera.up.copy(up);
    this.camera.position
      .set(
        Math.cos(this.elevation) * Math.cos(this.azimuth),
        Math.cos(this.elevation) * Math.sin(this.azimuth),
        Math.sin(this.elevation),
      )
      .multiplyScalar(this.distance)
      .add(this.center);
    this.camera.lookAt(this.center);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.placePlane();
    this.renderer.render(this.scene, this.camera);
    ++this.drawn;
  }

  /** Puts the cutting plane through the probe; the viewer's side is cut away. */
  private placePlane(): void {
    const toViewer = this.camera.position.clone().sub(this.center);
    const normal = new THREE.Vector3();
    if (this.cut === "view") normal.copy(toViewer).normalize().negate();
    if (this.cut === "x") normal.set(-Math.sign(toViewer.x) || -1, 0, 0);
    if (this.cut === "y") normal.set(0, -Math.sign(toViewer.y) || 1, 0);
    if (this.cut === "z") normal.set(0, 0, -Math.sign(toViewer.z) || -1);
    if (this.cut !== "off") this.plane.setFromNormalAndCoplanarPoint(normal, this.probe);
  }
}
