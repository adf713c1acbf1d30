// How finely surfaces are drawn: whole at rest, and while something moves as well, unless that is too slow here.

import * as THREE from "three";

const slow = 60; // [ms] between frames
const patience = 3; // slow pictures one after the other
const backlog = 3; // frames in which a picture that was hard to draw may hold up the page
const rest = 250; // [ms] without a change, after which surfaces are drawn whole again
const cells = 50; // along the diagonal of a surface's bounds

/** The triangles that are left when all points of a cell become its first one. */
function coarsened(points: Float32Array, index: Uint32Array, cell: number): Uint32Array {
  const firsts = new Map<number, number>();
  const first = new Uint32Array(points.length / 3);
  const side = 1 << 16;
  for (let i = 0; i < first.length; ++i) {
    const [x, y, z] = [0, 1, 2].map((axis) => Math.floor(points[3 * i + axis]! / cell) + side / 2) as [number, number, number];
    const key = x + side * (y + side * z);
    const known = firsts.get(key);
    if (known === undefined) firsts.set(key, i);
    first[i] = known ?? i;
  }
  const out: number[] = [];
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = [first[index[t]!]!, first[index[t + 1]!]!, first[index[t + 2]!]!];
    if (a !== b && b !== c && c !== a) out.push(a, b, c);
  }
  return new Uint32Array(out);
}

export class Detail {
  private readonly coarse = new Map<THREE.Mesh, { whole: THREE.BufferAttribute; coarse: THREE.BufferAttribute }>();
  /** Surfaces are drawn with all their triangles. */
  isWhole = true;
  private isSlow = false;
  private slowPictures = 0;
  private framesSince = backlog; // the last picture
  private calledAt = 0; // [ms]
  private changedAt = -1e9; // [ms]

  add(mesh: THREE.Mesh): void {
    mesh.geometry.computeBoundingBox();
    const box = mesh.geometry.boundingBox!;
    const cell = box.min.distanceTo(box.max) / cells;
    if (!(cell > 0)) return;
    const points = mesh.geometry.getAttribute("position").array as Float32Array;
    const whole = mesh.geometry.getIndex()!;
    const less = coarsened(points, whole.array as Uint32Array, cell);
    this.coarse.set(mesh, { whole, coarse: new THREE.BufferAttribute(less, 1) });
    this.isSlow = false; // with other surfaces it is to be seen anew
    this.slowPictures = 0;
    this.show(mesh);
  }

  remove(mesh: THREE.Mesh): void {
    this.coarse.delete(mesh);
  }

  private show(mesh: THREE.Mesh): void {
    const each = this.coarse.get(mesh)!;
    mesh.geometry.setIndex(this.isWhole ? each.whole : each.coarse);
    // Two passes, the back faces first, look better and take twice the time.
    (mesh.material as THREE.Material).forceSinglePass = !this.isWhole;
  }

  /** To be called once in each frame: a picture takes time after it was asked for, and only the frames show how much. */
  private watch(now: number): void {
    const gap = now - this.calledAt;
    this.calledAt = now;
    if (!this.isWhole || this.framesSince >= backlog) return;
    ++this.framesSince;
    if (gap > slow) {
      ++this.slowPictures;
      this.framesSince = backlog;
    } else if (this.framesSince === backlog) {
      this.slowPictures = 0;
    }
    if (this.slowPictures >= patience) this.isSlow = true;
  }

  /**
   * Called once in each frame, at `now` [ms]; `hasChanged`: the picture has. Whether it is to be drawn, and if so, all meshes are as
   * fine as they are to be.
   */
  isDue(now: number, hasChanged: boolean): boolean {
    this.watch(now);
    if (hasChanged) this.changedAt = now;
    const isAtRest = now - this.changedAt > rest;
    if (!hasChanged && (this.isWhole || !isAtRest)) return false;
    this.framesSince = 0;
    const isWhole = !this.isSlow || isAtRest;
    if (isWhole !== this.isWhole) {
      this.isWhole = isWhole;
      for (const mesh of this.coarse.keys()) this.show(mesh);
    }
    return true;
  }
}
