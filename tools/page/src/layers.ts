// The list of layers: color, name, on and off, opacity.

import type { Space } from "./space";
import type { SceneWords } from "./wire";

export interface LayerLook {
  visible: boolean;
  opacity: number;
}

/** Visibility and opacity are kept by name when another scene is shown. */
export class Layers {
  private readonly looks = new Map<string, LayerLook>();
  private rows: HTMLLIElement[] = [];

  constructor(
    private readonly list: HTMLElement,
    private readonly space: Space,
  ) {}

  begin(words: SceneWords): void {
    this.rows = words.regions.map((region, index) => {
      const row = document.createElement("li");
      if (region.color === null) {
        row.textContent = `${region.name} (around all layers)`;
        return row;
      }
      const look = this.look(region.name, index, words.regions.length);
      const on = document.createElement("input");
      on.type = "checkbox";
      on.checked = look.visible;
      on.id = `layer-${index}`;
      const swatch = document.createElement("span");
      swatch.className = "swatch";
      swatch.style.background = region.color;
      const name = document.createElement("label");
      name.className = "name";
      name.htmlFor = on.id;
      name.textContent = region.name;
      const opacity = document.createElement("input");
      opacity.type = "range";
      opacity.min = "0.05";
      opacity.max = "1";
      opacity.step = "0.05";
      opacity.value = String(look.opacity);
      opacity.setAttribute("aria-label", `opacity of ${region.name}`);
      const about = document.createElement("span");
      about.className = "words";
      about.textContent = `wall ${region.wall}; content ${region.content}`;
      const change = () => {
        look.visible = on.checked;
        look.opacity = Number(opacity.value);
        this.space.look(index, look.opacity, look.visible);
      };
      on.addEventListener("change", change);
      opacity.addEventListener("input", change);
      row.append(on, swatch, name, opacity, about);
      return row;
    });
    this.list.replaceChildren(...this.rows);
  }

  look(name: string, index: number, count: number): LayerLook {
    const known = this.looks.get(name);
    if (known !== undefined) return known;
    // Outer layers are translucent, so that inner ones are visible.
    const made = { visible: true, opacity: count > 2 && index === count - 1 ? 0.9 : 0.55 };
    this.looks.set(name, made);
    return made;
  }

  /** The probe is in region `here`. */
  mark(here: number): void {
    this.rows.forEach((row, index) => row.classList.toggle("here", index === here));
  }
}
