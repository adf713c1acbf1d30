// The scene's text as its file holds it, and what became of the last edit.

import { fetchText, type SceneText } from "./wire";

const byId = (id: string): HTMLElement => document.getElementById(id)!;

export class Edits {
  private shown = -1; // SceneText.edit
  private isLoading = false;

  /** The text changed `edit` times so far. */
  take(edit: number): void {
    if (edit !== this.shown && !this.isLoading) void this.load();
  }

  private async load(): Promise<void> {
    this.isLoading = true;
    try {
      this.show(await fetchText());
    } catch {
      // The server has ended, and the page says so.
    }
    this.isLoading = false;
  }

  private show(now: SceneText): void {
    this.shown = now.edit;
    const bad = now.state === "refused";
    const lines = byId("lines");
    lines.replaceChildren(
      ...now.text.split("\n").map((text, index) => {
        const row = document.createElement("li");
        row.textContent = text;
        row.classList.toggle("bad", bad && index + 1 === now.line);
        return row;
      }),
    );
    const about = byId("edit");
    about.textContent = this.words(now);
    about.hidden = about.textContent === "";
    about.classList.toggle("bad", bad);
    byId("tab-text").classList.toggle("bad", bad);
    lines.querySelector(".bad")?.scrollIntoView({ block: "nearest" });
  }

  private words(now: SceneText): string {
    switch (now.state) {
      case "felt":
        return "";
      case "compiling":
        return "The scene's file has changed; what it says now is made ready.";
      case "recorded":
        return "The scene's file has changed. This session is recorded, and goes on in the scene as it was.";
      case "refused": {
        const where = now.line === null ? "" : `Line ${now.line}: `;
        const hint = now.hint ? `\n${now.hint}` : "";
        return `${where}${now.problem}${hint}\nThe scene goes on as it was.`;
      }
    }
  }
}
