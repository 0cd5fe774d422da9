// Appearance of each method, the same as in the report's figures for print.

import { look, page } from "./data";

/** Style sheet with a variable for each label's colour, in a light and a dark version. */
export function colours(): string {
  const each = page.labels.map((_, i) => [i, look(i).colour] as const);
  const light = each.map(([i, c]) => `--m${i}:${c}`).join(";");
  const dark = each.map(([i, c]) => `--m${i}:color-mix(in oklab,${c} 62%,#fff)`).join(";");
  return `:root{${light}}@media screen and (prefers-color-scheme:dark){:root{${dark}}}`;
}

export const colour = (label: number): string => `var(--m${label})`;

const corners: Record<string, [number, number, number]> = {
  circle: [0, 0, 1], square: [4, 0.125, 1.25], triangle: [3, 0, 1.35], diamond: [4, 0, 1.3], down: [3, 0.5, 1.35],
  pentagon: [5, 0, 1.15], hexagon: [6, 0, 1.1],
};

/** Draws the outline of a marker of radius `r` into a drawing context. */
export function outline(context: { moveTo(x: number, y: number): void; lineTo(x: number, y: number): void;
  closePath(): void; arc(x: number, y: number, r: number, a: number, b: number): void }, marker: string, r: number) {
  const [n, turn, scale] = corners[marker] ?? corners.circle;
  if (n === 0) {
    context.moveTo(r, 0);
    context.arc(0, 0, r, 0, 2 * Math.PI);
    return;
  }
  for (let k = 0; k < n; k++) {
    const angle = 2 * Math.PI * (k / n + turn);
    const at = [r * scale * Math.sin(angle), -r * scale * Math.cos(angle)] as const;
    if (k) context.lineTo(...at); else context.moveTo(...at);
  }
  context.closePath();
}

/** Marker of a label as a symbol of Observable Plot, with the requested area. */
export const symbol = (label: number) => ({
  draw: (context: CanvasPath, size: number) => outline(context, look(label).marker, Math.sqrt(size / Math.PI)),
});

/** Small picture of a label's line and marker, for a legend. */
export function key(label: number): SVGSVGElement {
  const { marker, dash, open } = look(label);
  const steps: string[] = [];
  outline({
    moveTo: (x, y) => steps.push(`M${x},${y}`), lineTo: (x, y) => steps.push(`L${x},${y}`), closePath: () => steps.push("Z"),
    arc: (_x, _y, r) => steps.push(`A${r},${r} 0 1 1 ${-r},0A${r},${r} 0 1 1 ${r},0`),
  }, marker, 4);
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "-14 -7 28 14");
  svg.setAttribute("aria-hidden", "true");
  svg.innerHTML =
    `<path d="M-14,0H14" stroke="${colour(label)}" stroke-width="1.6" stroke-dasharray="${dash.join(" ")}"/>` +
    `<path d="${steps.join("")}" stroke="${colour(label)}" stroke-width="1.5" fill="${open ? "var(--paper)" : colour(label)}"/>`;
  return svg;
}
