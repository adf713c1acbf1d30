// The scan's gray values on three planes, which the probe leads or sliders.

import * as THREE from "three";
import type { Space } from "./space";
import { fetchSlice, fetchSlices, type SliceWords, type Vector } from "./wire";

const byId = (id: string): HTMLElement => document.getElementById(id)!;

const names = ["sagittal", "coronal", "axial"] as const; // across x, y and z
const axes = ["x", "y", "z"] as const;
const first = 1; // the one that is shown at first: where the page cuts

/** One plane: what is wanted of it, what was asked for, and what is shown. */
class Slice {
  readonly box = document.createElement("input");
  readonly place = document.createElement("input");
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial>;
  shown = -1;
  private isAsked = false;

  constructor(
    readonly axis: number,
    private readonly scene: number,
    private readonly words: SliceWords,
  ) {
    const count = words.counts[axis]!;
    this.box.type = "checkbox";
    this.box.id = `slice-${axes[axis]!}`;
    this.box.checked = axis === first;
    this.place.type = "range";
    this.place.min = "0";
    this.place.max = String(count - 1);
    this.place.value = String(Math.floor(count / 2));
    this.place.setAttribute("aria-label", `place of the ${names[axis]!} slice`);
    // Wholly drawn or not at all, so that it need not be sorted with the layers.
    this.mesh = new THREE.Mesh(
      this.plane(),
      new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, alphaTest: 0.5 }),
    );
    this.mesh.visible = false;
  }

  get row(): HTMLLIElement {
    const row = document.createElement("li");
    const name = document.createElement("label");
    name.htmlFor = this.box.id;
    name.textContent = `${names[this.axis]!}, across ${axes[this.axis]!}`;
    row.append(this.box, name, this.place);
    return row;
  }

  /** The lattice's face across the axis, at its lower end. */
  private plane(): THREE.BufferGeometry {
    const { lo, hi } = this.words.box;
    const u = this.axis === 0 ? 1 : 0;
    const v = this.axis === 2 ? 1 : 2;
    const corners = [0, 1, 2, 3].map((i) => {
      const corner = [0, 0, 0];
      corner[u] = i % 2 === 0 ? lo[u] : hi[u];
      corner[v] = i < 2 ? lo[v] : hi[v];
      return corner;
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners.flat()), 3));
    geometry.setAttribute("uv", new THREE.BufferAttribute(new Float32Array([0, 0, 1, 0, 0, 1, 1, 1]), 2));
    geometry.setIndex([0, 1, 2, 1, 3, 2]);
    return geometry;
  }

  private step(): number {
    return (this.words.box.hi[this.axis]! - this.words.box.lo[this.axis]!) / this.words.counts[this.axis]!;
  }

  follow(probe: Vector): void {
    const index = Math.floor((probe[this.axis]! - this.words.box.lo[this.axis]!) / this.step());
    this.place.value = String(Math.min(Math.max(index, 0), this.words.counts[this.axis]! - 1));
  }

  /** One request at a time: what is wanted meanwhile comes next. True if another slice is shown after it. */
  async fetch(): Promise<boolean> {
    const wanted = Number(this.place.value);
    if (!this.box.checked || this.isAsked || wanted === this.shown) return false;
    this.isAsked = true;
    try {
      const image = await fetchSlice(this.scene, this.axis, wanted);
      if (image !== null) this.put(image, wanted);
      return image !== null;
    } finally {
      this.isAsked = false;
    }
  }

  private put(image: ImageData, index: number): void {
    const { material } = this.mesh;
    material.map?.dispose();
    const texture = new THREE.DataTexture(image.data, image.width, image.height);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    material.map = texture;
    material.needsUpdate = true;
    this.mesh.position.setComponent(this.axis, this.words.box.lo[this.axis]! + (index + 0.5) * this.step());
    this.shown = index;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.map?.dispose();
    this.mesh.material.dispose();
  }
}

export class Slices {
  slices: Slice[] = [];
  private scene = -1;
  private isComing = false;
  private readonly follows = byId("slices-follow") as HTMLInputElement;

  constructor(private readonly space: Space) {}

  /** Another scene. */
  begin(): void {
    for (const slice of this.slices) {
      this.space.remove(slice.mesh);
      slice.dispose();
    }
    this.slices = [];
    this.scene = -1;
    byId("slices").hidden = true;
  }

  /** They are there for scene `number`. */
  async come(number: number): Promise<void> {
    if (this.isComing || this.scene === number) return;
    this.isComing = true;
    try {
      const words = await fetchSlices(number);
      this.begin();
      this.scene = number;
      if (words === null) return;
      this.slices = [2, 1, 0].map((axis) => new Slice(axis, number, words));
      for (const slice of this.slices) {
        slice.place.addEventListener("input", () => (this.follows.checked = false));
        this.space.add(slice.mesh);
      }
      byId("slices-file").textContent = words.file;
      byId("slice-list").replaceChildren(...this.slices.map((slice) => slice.row));
      byId("slices").hidden = false;
    } finally {
      this.isComing = false;
    }
  }

  /** Once a frame. */
  step(probe: Vector | null): void {
    for (const slice of this.slices) {
      if (probe !== null && this.follows.checked) slice.follow(probe);
      void slice.fetch().then((isNew) => {
        if (isNew) this.space.changed();
      });
      const isVisible = slice.box.checked && slice.shown >= 0;
      if (slice.mesh.visible !== isVisible) this.space.changed();
      slice.mesh.visible = isVisible;
      // The cut lays a slice open that is in its own plane.
      slice.mesh.material.clippingPlanes = this.space.cut === axes[slice.axis] ? [] : this.space.clipping;
    }
  }
}
