// A short tour through what can be done here. It opens once on this machine, and whenever it is asked for.

import type { SceneWords, Tick } from "./wire";

const byId = (id: string): HTMLElement => document.getElementById(id)!;

interface Step {
  title: string;
  text: string;
  /** Whether it was done; without it the step is there to be read. */
  done?: (now: Tick, first: Tick, words: SceneWords) => boolean;
}

const far = (now: Tick, first: Tick, words: SceneWords): boolean => {
  const { lo, hi } = words.box;
  const size = Math.hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
  return Math.hypot(...now.hip.map((x, i) => (x ?? 0) - (first.hip[i] ?? 0))) > 0.05 * size;
};
const pressed = (now: Tick): boolean => now.contact && Math.hypot(...now.force) > 0.3;
const isIn =
  (name: string) =>
  (now: Tick, _: Tick, words: SceneWords): boolean =>
    words.regions[now.region]?.name === name;

const lead: Step = {
  title: "Lead the hand",
  text: "Hold an arrow key, or drag with the mouse; Page Down, or the wheel, goes away from you. The pale ball is where you lead the hand, and the orange ball, the hand, follows.",
  done: far,
};
const press: Step = {
  title: "Press on a wall",
  text: "Go on until something holds you. The blue ball, the proxy, stays on the wall; the yellow arrow is the force on the hand, which draws it back.",
  done: pressed,
};
const next = (text: string): Step => ({ title: "Go on", text });

/** By the name of the scene's file. */
const tours = new Map<string, Step[]>([
  [
    "container.yaml",
    [
      lead,
      {
        title: "Dip into the syrup",
        text: "Go down through the mouth, which is marked green as each port is. The region at the upper right changes, and the table below lights the transition.",
        done: isIn("liquid"),
      },
      {
        title: "Press on the glass",
        text: "Go down to the bottom. The blue ball, the proxy, stays on the glass; the yellow arrow is the force on the hand, which draws it back. From outside you would not get in here: the glass is no port.",
        done: pressed,
      },
      next("The next scene is a scanned head: palpate view data/scenes/head.yaml"),
    ],
  ],
  [
    "head.yaml",
    [
      lead,
      press,
      {
        title: "Look at the scan",
        text: "The boxes at the left show three gray slices, at the probe or where their sliders are. All that lies before the cut is left out, so that you see where the probe is.",
      },
      {
        title: "Go to the brain",
        text: "The green patch at the back of the left side is a burr hole. Turn the view with Shift and the arrow keys, or the right mouse button, and lead the hand through it.",
        done: isIn("brain"),
      },
      next("The next scene has a needle in this head: palpate view data/scenes/needle.yaml"),
    ],
  ],
  [
    "needle.yaml",
    [
      lead,
      {
        title: "Go to the brain",
        text: "The green patch at the back of the left side is a burr hole. Lead the needle's tip through it: in the brain, a bright rod shows the shaft, which the tissue holds.",
        done: isIn("brain"),
      },
      {
        title: "Pierce the thalamus",
        text: "Go on towards the small layer in the middle and press: its wall gives way, and a ring marks the hole, through which you come back more easily.",
        done: isIn("thalamus"),
      },
      next("To go through a record tick by tick: palpate touch SCENE ... --record felt.npy, then palpate view SCENE --replay felt.npy"),
    ],
  ],
]);
const anyScene: Step[] = [lead, press, next("The tours of data/scenes/container.yaml, head.yaml and needle.yaml show ports, scans and needles.")];

// The server has another port each time, and the browser's local storage is another one for each port. Cookies are not.
const seen = "palpate_tour=seen";
const wasSeen = (): boolean => document.cookie.split("; ").includes(seen);
const markSeen = (): void => {
  const year = 365 * 24 * 3600; // [s]
  document.cookie = `${seen}; path=/; max-age=${year}; samesite=strict`;
};

export class Tour {
  private readonly panel = byId("tour");
  private readonly forward = byId("tour-next") as HTMLButtonElement;
  private readonly back = byId("tour-back") as HTMLButtonElement;
  private steps: Step[] = [];
  private at = 0;
  private first: Tick | null = null;
  private words: SceneWords | null = null;

  /** `onClose`: whoever had the keys gets them back. */
  constructor(private readonly onClose: () => void) {
    this.forward.addEventListener("click", () => this.go(this.at + 1));
    this.back.addEventListener("click", () => this.go(this.at - 1));
    byId("tour-close").addEventListener("click", () => this.close());
    byId("tour-open").addEventListener("click", () => {
      this.open();
      this.forward.focus();
    });
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && !this.panel.hidden) this.close();
    });
  }

  begin(words: SceneWords): void {
    const isFirst = this.words === null;
    this.words = words;
    this.steps = tours.get(words.file) ?? anyScene;
    byId("tour-open").hidden = words.mode === "replay";
    if (isFirst && words.mode !== "replay" && !wasSeen()) this.open();
  }

  open(): void {
    this.panel.hidden = false;
    this.go(0);
  }

  close(): void {
    this.panel.hidden = true;
    // Not before: who leaves without closing it sees it again.
    markSeen();
    this.onClose();
  }

  private go(to: number): void {
    if (to >= this.steps.length) {
      this.close();
      return;
    }
    this.at = Math.max(to, 0);
    this.first = null;
    const step = this.steps[this.at]!;
    byId("tour-title").textContent = `${this.at + 1} of ${this.steps.length}: ${step.title}`;
    byId("tour-text").textContent = step.text;
    byId("tour-done").textContent = "";
    this.back.disabled = this.at === 0;
    this.forward.textContent = this.at === this.steps.length - 1 ? "Close" : "Next";
  }

  showTick(tick: Tick): void {
    if (this.panel.hidden || this.words === null) return;
    this.first ??= tick;
    const done = this.steps[this.at]?.done;
    if (done?.(tick, this.first, this.words)) byId("tour-done").textContent = "Done.";
  }
}
