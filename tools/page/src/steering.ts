// Input that moves the hand and the view: pointer, wheel, keys, gamepad.

import type { Space } from "./space";
import type { Vector } from "./wire";

const keyStep = 0.35; // [1/s] share of the view's height while a key is held
const turnStep = 1.5; // [rad/s]
const wheelStep = 0.0004; // share of the view's height per pixel of the wheel
const stickRest = 0.15; // share of a stick's travel that is ignored

export interface Steered {
  told: Vector;
  start: Vector;
  /** False: a record or a device moves the hand, and all input moves the view. */
  readonly leads: boolean;
  /** The hand's place has changed. */
  changed(): void;
}

/** Calls `steered.changed()` when the hand gets another goal. */
export class Steering {
  private readonly held = new Set<string>();
  private drag: { button: number; x: number; y: number } | null = null;
  private last = performance.now();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly space: Space,
    private readonly steered: Steered,
  ) {
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      this.drag = { button: event.button, x: event.clientX, y: event.clientY };
      canvas.setPointerCapture(event.pointerId);
      canvas.focus();
    });
    canvas.addEventListener("pointermove", (event) => this.dragTo(event));
    canvas.addEventListener("pointerup", () => (this.drag = null));
    canvas.addEventListener("pointercancel", () => (this.drag = null));
    canvas.addEventListener("wheel", (event) => this.roll(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.press(event));
    canvas.addEventListener("keyup", (event) => this.held.delete(event.key));
    canvas.addEventListener("blur", () => this.held.clear());
  }

  /** To be called once in each frame: handles held keys, and the gamepad. */
  step(): void {
    const now = performance.now();
    const dt = Math.min((now - this.last) / 1000, 0.1);
    this.last = now;
    const axis = (less: string, more: string) => (this.held.has(more) ? 1 : 0) - (this.held.has(less) ? 1 : 0);
    const x = axis("ArrowLeft", "ArrowRight");
    const y = axis("ArrowDown", "ArrowUp");
    const z = axis("PageUp", "PageDown");
    if (this.held.has("Shift") || !this.steered.leads) {
      this.space.turn(turnStep * dt * x, turnStep * dt * y);
      this.go(0, 0, keyStep * dt * z);
    } else {
      this.go(keyStep * dt * x, keyStep * dt * y, keyStep * dt * z);
    }
    for (const pad of navigator.getGamepads()) {
      if (pad === null) continue;
      const stick = (i: number) => {
        const value = pad.axes[i] ?? 0;
        return Math.abs(value) > stickRest ? value : 0;
      };
      this.go(keyStep * dt * stick(0), -keyStep * dt * stick(1), -keyStep * dt * stick(3));
      this.space.turn(-turnStep * dt * stick(2), 0);
    }
  }

  private go(right: number, upward: number, away: number): void {
    if (!this.steered.leads || (right === 0 && upward === 0 && away === 0)) return;
    this.steered.told = this.space.moved(this.steered.told, right, upward, away);
    this.steered.changed();
  }

  private dragTo(event: PointerEvent): void {
    if (this.drag === null) return;
    const x = (event.clientX - this.drag.x) / this.canvas.clientHeight;
    const y = (event.clientY - this.drag.y) / this.canvas.clientHeight;
    this.drag = { ...this.drag, x: event.clientX, y: event.clientY };
    if (this.drag.button === 0 && this.steered.leads) {
      this.go(x, -y, 0);
    } else {
      this.space.turn(-4 * x, 4 * y);
    }
  }

  private roll(event: WheelEvent): void {
    event.preventDefault();
    if (event.ctrlKey || !this.steered.leads) {
      this.space.zoom(Math.exp(0.0015 * event.deltaY));
    } else {
      this.go(0, 0, -wheelStep * event.deltaY);
    }
  }

  private press(event: KeyboardEvent): void {
    const moves = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "PageUp", "PageDown", "Shift"];
    if (moves.includes(event.key)) {
      this.held.add(event.key);
    } else if (event.key === "Home" && this.steered.leads) {
      this.steered.told = [...this.steered.start];
      this.steered.changed();
    } else if (event.key === "+" || event.key === "-") {
      this.space.zoom(event.key === "+" ? 0.9 : 1 / 0.9);
    } else {
      return;
    }
    event.preventDefault();
  }
}
