// Functions that create HTML elements.

type Child = Node | string | null | false | undefined;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void) | undefined>;

/** Creates an element with attributes and children. A function is added as an event listener; attributes and
 * children that are `false` are omitted. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") made.addEventListener(key, value);
    else if (value !== undefined && value !== false) made.setAttribute(key, value === true ? "" : String(value));
  }
  for (const child of children) if (child) made.append(child);
  return made;
}

/** Creates a drop-down list. `options` are pairs of value and text; `change` receives the chosen value. */
export function select(
  label: string, options: [string, string][], value: string, change: (value: string) => void,
): HTMLSelectElement {
  const picked = (event: Event) => change((event.target as HTMLSelectElement).value);
  const option = ([key, text]: [string, string]) => h("option", { value: key, selected: key === value }, text);
  return h("select", { "aria-label": label, change: picked }, ...options.map(option));
}

/** Creates a folding section, whose content is made when it is first opened. */
export function folded(summary: Child[], id: string, open: boolean, make: (body: HTMLElement) => void): HTMLDetailsElement {
  const body = h("div", { class: "body" });
  const made = h("details", { id, open }, h("summary", {}, ...summary), body);
  let empty = true;
  const fill = () => {
    if (made.open && empty) { empty = false; make(body); }
  };
  made.addEventListener("toggle", fill);
  fill();
  return made;
}
