// What is marked in the scene: ports on the surfaces, holes, and the shaft of a needle.

import * as THREE from "three";
import { styleColor, type Space } from "./space";
import { fetchPort, type SceneWords, type Surface, type Tick, type Vector } from "./wire";

const byId = (id: string): HTMLElement => document.getElementById(id)!;
const mostHoles = 32; // as many as a scene remembers
const opacities = { opening: 0.5, wall: 0.1 }; // of a port in a wall, and of a wall that is all port

export class Marks {
  /** Ports that are on some surface, once all are known. */
  ports: THREE.Mesh[] = [];
  private readonly patches = new THREE.Group();
  private readonly rings: THREE.Mesh[] = [];
  private readonly shaft: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  private readonly box = byId("ports-on") as HTMLInputElement;
  /** All ports of the scene are shown that are on some surface. */
  isComplete = false;
  private size = 1;
  private scene = -1;

  constructor(private readonly space: Space) {
    const ring = new THREE.RingGeometry(0.6, 1, 32);
    for (let i = 0; i < mostHoles; ++i) {
      const mesh = new THREE.Mesh(ring, this.material("--hole", 1));
      mesh.renderOrder = 2;
      mesh.visible = false;
      this.rings.push(mesh);
      space.add(mesh);
    }
    // From 0 to 1 along z.
    const rod = new THREE.CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0).rotateX(Math.PI / 2);
    this.shaft = new THREE.Mesh(rod, this.material("--shaft", 0.85));
    this.shaft.renderOrder = 3;
    this.shaft.visible = false;
    space.add(this.shaft);
    space.add(this.patches);
    this.box.addEventListener("change", () => {
      this.patches.visible = this.box.checked;
      this.space.changed();
    });
  }

  /** Seen through all layers. */
  private material(color: string, opacity: number): THREE.MeshBasicMaterial {
    return new THREE.MeshBasicMaterial({
      color: styleColor(color),
      side: THREE.DoubleSide,
      depthTest: false,
      transparent: true,
      opacity,
    });
  }

  begin(words: SceneWords): void {
    this.clear();
    this.isComplete = false;
    this.scene = -1;
    const { lo, hi } = words.box;
    this.size = Math.hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
    byId("ports").hidden = words.ports.length === 0;
    byId("mark-port").hidden = words.ports.length === 0;
  }

  private clear(): void {
    for (const port of this.ports) {
      this.space.detail.remove(port);
      port.geometry.dispose();
    }
    this.ports = [];
    this.patches.clear();
  }

  /** Whether the port is most of the wall of a layer, as where a needle may go in anywhere: marked like an opening it would hide all else. */
  private isWall(words: SceneWords, port: number, surface: Surface): boolean {
    return words.transitions
      .filter((transition) => transition.port === port)
      .flatMap(({ from, to }) => [this.space.triangles(from), this.space.triangles(to)])
      .some((whole) => whole > 0 && surface.indices.length / 3 > 0.5 * whole);
  }

  /** The ports of the scene `words` are known. */
  async come(words: SceneWords): Promise<void> {
    if (this.scene === words.number) return;
    this.scene = words.number;
    const surfaces = await Promise.all(words.ports.map((_, port) => fetchPort(words.number, port)));
    if (this.scene !== words.number) return;
    this.clear();
    for (const [port, surface] of surfaces.entries()) {
      if (surface === null) continue;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(surface.points, 3));
      geometry.setIndex(new THREE.BufferAttribute(surface.indices, 1));
      const material = new THREE.MeshBasicMaterial({
        color: styleColor("--port"),
        side: THREE.DoubleSide,
        transparent: true,
        opacity: this.isWall(words, port, surface) ? opacities.wall : opacities.opening,
        depthWrite: false,
        // Before the surface that it is part of.
        polygonOffset: true,
        polygonOffsetFactor: -2,
        polygonOffsetUnits: -2,
        clippingPlanes: this.space.clipping,
      });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.renderOrder = 1;
      this.ports.push(mesh);
      this.patches.add(mesh);
      this.space.detail.add(mesh);
    }
    this.isComplete = true;
    this.space.changed();
  }

  showTick(tick: Tick): void {
    this.rings.forEach((ring, i) => {
      const hole = tick.holes[i];
      ring.visible = hole !== undefined;
      if (hole === undefined) return;
      ring.position.set(...hole.point);
      // A small one has to be seen as well.
      ring.scale.setScalar(Math.max(hole.radius, 0.008 * this.size));
      ring.lookAt(new THREE.Vector3(...hole.point).add(new THREE.Vector3(...hole.normal)));
    });
    byId("mark-hole").hidden = tick.holes.length === 0;
    this.showShaft(tick.proxy, tick.shaft);
  }

  /** From the tip through where it went in, and out of the scene. */
  private showShaft(tip: Vector, fulcrum: Vector | null): void {
    const way = fulcrum === null ? null : new THREE.Vector3(...fulcrum).sub(new THREE.Vector3(...tip));
    const length = way?.length() ?? 0;
    this.shaft.visible = length > 1e-6 * this.size;
    byId("mark-shaft").hidden = !this.shaft.visible;
    if (!this.shaft.visible || way === null) return;
    this.shaft.position.set(...tip);
    this.shaft.lookAt(this.shaft.position.clone().add(way));
    this.shaft.scale.set(0.0025 * this.size, 0.0025 * this.size, length + 0.3 * this.size);
  }
}
