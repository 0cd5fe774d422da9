// The page: first the question, then the sections with the results behind its answer.

import { colours } from "./look";
import { legend, put, type Chart, type Point } from "./chart";
import { name, page, type Ask, type PlotData, type Table } from "./data";
import { folded, h, select } from "./dom";
import { MEASURES, over, steps } from "./commits";
import { answer, chart, lines, question } from "./front";
import { map, mapKey, tally } from "./map";
import type { Body } from "./solid";
import { address, change, fits, isOff, listen, state, toggle } from "./state";
import { rowsLeft, sheet } from "./table";
import { digits, list, percent, plural, slug, whole } from "./text";

declare global {
  interface Window { showBodies?: (place: HTMLElement, bodies: Body[]) => void }
}

const main = document.getElementById("page")!;

/** Elements that filters may hide, each with a test whether it is shown. */
const filtered: [HTMLElement, () => boolean][] = [];

function keep(element: HTMLElement, test: () => boolean): HTMLElement {
  filtered.push([element, test]);
  return element;
}

const ofCase = (it: string) => !state.only || !it || it === state.only;

/** Opens a section, scrolls to it and focuses its heading. */
function go(id: string) {
  const found = document.getElementById(id);
  if (!found) return;
  for (let up: HTMLElement | null = found; up; up = up.parentElement) if (up instanceof HTMLDetailsElement) up.open = true;
  found.scrollIntoView({ block: "start" });
  const focus = found.querySelector<HTMLElement>("summary, h2") ?? found;
  if (focus.tagName === "H2") focus.tabIndex = -1;
  focus.focus({ preventScroll: true });
}

const link = (id: string, text: string, kind = "") =>
  h("a", { href: address({ at: id }), class: kind, click: (event) => { event.preventDefault(); change({ at: id }); go(id); } }, text);

const section = (id: string, title: string, ...content: (Node | string | null | false)[]) =>
  h("section", { id }, h("h2", {}, title), ...content);

function header(): HTMLElement {
  const c = page.counts;
  const checks = c.pass + c.fail + c.known + c.not_run;
  const items: (HTMLElement | false)[] = [
    h("li", {}, plural(page.cases.length, "case")), h("li", {}, plural(c.runs, "run")), h("li", {}, plural(c.numbers, "number")),
    h("li", {}, checks ? link("table-checks", `${plural(c.pass, "check")} passed`) : "no checks"),
    c.fail > 0 && h("li", { class: "bad" }, link("table-checks", `${c.fail} failed`)),
    c.known > 0 && h("li", {}, link("table-checks", `${c.known} known not to pass`)),
    c.not_run > 0 && h("li", {}, link("table-checks", `${c.not_run} not run`)),
    c.failures > 0 && h("li", { class: "bad" }, link("solvers", `${plural(c.failures, "run")} without a result`)),
    c.partial > 0 && h("li", { class: "bad" }, link("solvers", `${plural(c.partial, "run")} with only part of the load`)),
    c.warnings > 0 && h("li", {}, link("table-warnings", plural(c.warnings, "warning"))),
    c.failures + c.partial === 0 && h("li", {}, link("solvers", "no run failed")),
  ];
  return h("header", {}, h("p", { class: "soft small" },
    `tissuebench ${page.program.version}, ${page.source || "results"}, commit ${page.program.commit.slice(0, 10)}${page.program.dirty ? "+" : ""}`),
    h("ul", { class: "tally" }, ...items));
}

function toolbar(): HTMLElement {
  const field = (key: "method" | "find", text: string, hint: string) => {
    const made = h("input", { type: "search", value: state[key], placeholder: hint, "aria-label": text, id: `filter-${key}`,
      input: (event) => change({ [key]: (event.target as HTMLInputElement).value }) });
    listen((changed) => { if (changed.includes(key) && made.value !== state[key]) made.value = state[key]; });
    return made;
  };
  const cases: [string, string][] = [["", "all cases"], ...page.cases.map((c): [string, string] => [c.name, c.name])];
  const only = select("Cases shown on the page", cases, state.only, (to) => change({ only: to }));
  only.id = "filter-only";
  listen((changed) => { if (changed.includes("only")) only.value = state.only; });
  const clear = h("button", { type: "button", class: "quiet", click: () => change({ only: "", method: "", find: "", off: "" }) }, "clear");
  const shown = () => { clear.hidden = !(state.only || state.method || state.find || state.off); };
  shown();
  listen(shown);
  return h("div", { class: "toolbar", role: "search", "aria-label": "Filters of the whole page" },
    only, field("method", "Methods shown: words to find, or -word to exclude", "methods, e.g. hex"), field("find", "Search in tables and findings", "search"), clear);
}

/** Chart of one of the report's plots. */
function plain(data: PlotData): Chart {
  const points = (curve: PlotData["curves"][number]): Point[] => {
    const out: Point[] = [];
    for (let i = 0; 2 * i < curve.xy.length; i++)
      out.push({ label: curve.label, x: curve.xy[2 * i], y: curve.xy[2 * i + 1], run: curve.runs?.[curve.runs.length === 1 ? 0 : i] ?? null });
    return out;
  };
  const shown = data.curves.filter((c) => !isOff(name(c.label)));
  return { title: data.title, x: data.x, y: data.y, lines: shown.map(points), height: 300,
    bands: shown.filter((c) => c.band).map((c) => ({ label: c.label, points: c.band! })) };
}

/** Figure with title, legend and plot, which is drawn again when a method is switched off or on. */
function figure(title: string, labels: number[], make: () => Chart, file: string | null): HTMLElement {
  const place = h("div");
  const chips = h("div");
  const fill = () => chips.replaceChildren(legend(labels, isOff, toggle));
  fill();
  let redraw: (() => void) | null = null;
  // A case has a dozen figures, so each is drawn only when it comes near the window.
  const draw = () => {
    redraw ??= put(place, make);
    seen.disconnect();
  };
  const seen = new IntersectionObserver((entries) => { if (entries.some((e) => e.isIntersecting)) draw(); }, { rootMargin: "600px" });
  // Figures in unfolded sections are drawn before printing.
  addEventListener("beforeprint", () => { if (made.checkVisibility()) draw(); });
  const made = h("figure", {}, h("h4", {}, title), chips, place, file && files(file));
  seen.observe(made);
  listen((changed) => {
    if (changed.some((key) => key === "off" || key === "method")) { fill(); redraw?.(); }
  });
  return made;
}

function files(figureName: string): HTMLElement | null {
  const known = page.figures.find((f) => f[0] === figureName);
  if (!known) return null;
  const one = (ending: string) => h("a", { href: `figures/${figureName}.${ending}` }, ending.toUpperCase());
  return h("figcaption", { class: "soft small" }, `${known[1]}: `, one("svg"), " ", one("png"), " ", one("pdf"), " ", known[2] ? one("csv") : null);
}

const efficiency: Record<string, string> = { displacement: "", pressure: "-pressure", "tool force": "-force", "peak displacement": "-peak" };

const front = (ask: Ask) =>
  figure(`${ask.kernels ? ask.title : ask.what + ask.title.slice(ask.case.length)}${ask.repeated ? ", solved in a loop" : ""}: run time against error`, ask.lines.map((l) => l.label),
    () => chart(ask, null), `efficiency${ask.repeated ? "-repeated" : ""}${efficiency[ask.what]}`);

/** Button that draws the bodies of a case in three dimensions; `null` if the page has none. */
function turned(of: string): HTMLElement | null {
  const data = document.getElementById(`bodies-${of}`);
  if (!data) return null;
  const place = h("div", { class: "solid" });
  const button = h("button", { type: "button", class: "quiet", click: () => {
    if (!window.showBodies) document.body.append(h("script", {}, document.getElementById("solid")!.textContent!));
    try {
      window.showBodies!(place, JSON.parse(data.textContent!));
      button.remove();
    } catch (bad) {
      place.textContent = `This browser cannot draw bodies in three dimensions (${bad instanceof Error ? bad.message : bad}).`;
    }
  } }, "Show in three dimensions, to turn, cut and see the stress");
  return h("div", {}, button, place);
}

/** Sentences that begin with the name of a case. */
const about = (sentences: string[], of: string) =>
  sentences.filter((s) => s.startsWith(of) && [":", " ", ","].includes(s[of.length]));

function caseSection(it: (typeof page.cases)[number]): HTMLElement {
  const asks = page.asks.filter((a) => a.case === it.name);
  const plots = page.plots.filter((p) => p.case === it.name && p.figure !== "locking");
  const locking = page.plots.filter((p) => p.case === it.name && p.figure === "locking");
  const pictures = page.pictures.filter((p) => p.case === it.name);
  const maps = page.maps.filter((m) => m.case === it.name);
  const summary = [h("b", {}, it.name), h("span", { class: "soft" }, ` ${it.title}`)];
  const made = folded(summary, `case-${slug(it.name)}`, false, (body) => {
    const sentences = h("ul", { class: "answers" });
    const say = () => sentences.replaceChildren(...asks.filter((a) => !a.kernels).map((a) =>
      h("li", {}, `${answer(a, lines(a), Number(state.within)).replace(/\.$/, "")}${a.repeated ? " (in a loop)." : "."} `,
        h("button", { type: "button", class: "quiet", click: () => { change({ case: a.case, what: a.what, clock: a.repeated ? "loop" : "once", off: "" }); scrollTo(0, 0); } }, "ask"))));
    say();
    listen((changed) => { if (changed.some((k) => ["within", "off", "method"].includes(k))) say(); });
    const found = page.findings.flatMap(([, all]) => about(all, it.name));
    body.append(
      ...(asks.length ? [sentences] : []),
      ...pictures.map((p) => {
        const sheet = h("div", { class: "picture", tabindex: 0, role: "img", "aria-label": p.title });
        sheet.innerHTML = p.svg;
        return h("figure", {}, h("h4", {}, p.title), p.name.startsWith("surface-") ? turned(it.name) : null, sheet, h("figcaption", { class: "soft small" }, `${p.caption}. `,
          h("a", { href: `figures/${p.name}.svg` }, "SVG"), " ", h("a", { href: `figures/${p.name}.png` }, "PNG"), " ", h("a", { href: `figures/${p.name}.pdf` }, "PDF")));
      }),
      h("div", { class: "figures" }, ...asks.map(front), ...locking.concat(plots).map(plotted)),
      ...maps.map((m) => link(`map-${slug(`${m.case} ${m.name}`)}`, `Where methods bend and break: ${m.name}`, "block")),
      ...(found.length ? [folded([plural(found.length, "more finding")], "", false, (inner) => inner.append(bullets(found)))] : []),
    );
    if (!body.childElementCount) body.append(h("p", { class: "soft" }, "The numbers of this case are in the tables."));
  });
  return keep(made, () => ofCase(it.name) && fits(`${it.name} ${it.title}`, state.find));
}

const plotted = (p: PlotData) => figure(p.title, [...new Set(p.curves.map((c) => c.label))], () => plain(p), p.figure);

const bullets = (sentences: string[]) =>
  h("ul", {}, ...sentences.map((s) => keep(h("li", {}, s), () => fits(s, state.find) && (!state.only || s.includes(state.only)))));

function locks(): HTMLElement | null {
  const topic = page.findings.find(([title]) => title === "Locking");
  const plots = page.plots.filter((p) => p.figure === "locking");
  if (!topic && !plots.length) return null;
  const show = (p: PlotData) => keep(plotted(p), () => ofCase(p.case));
  return section("locking", "Locking",
    h("p", { class: "soft" }, "A method that locks is accurate for compressible materials and wrong for nearly incompressible tissue: its error grows to the right."),
    topic ? bullets(topic[1]) : null, h("div", { class: "figures" }, ...plots.map(show)));
}

/** Section on the cheapest method: a table with a row for each method and a column for each case, and their
 * performance profile. */
function cheapest(): HTMLElement | null {
  const rows = table("within");
  if (!rows) return null;
  const plots = page.plots.filter((p) => p.figure === "profile");
  return section("within", `Which method is cheapest within ${percent(page.wanted, 1)}`, tableSection(rows, true),
    plots.length ? h("div", { class: "figures" }, ...plots.map(plotted)) : null);
}

function tableSection(table: Table, open = false): HTMLElement {
  const count = h("span", { class: "soft small" });
  const say = () => {
    const left = rowsLeft(table).length;
    const all = table.columns[0].rows.length;
    count.textContent = left === all ? plural(all, "row") : `${whole(left)} of ${plural(all, "row")}`;
  };
  say();
  listen((changed) => { if (changed.some((k) => ["only", "method", "find"].includes(k))) say(); });
  const file = (ending: string, text: string) => h("a", { href: `tables/${table.name}.${ending}` }, text);
  return keep(folded([h("b", {}, table.title), " ", count], `table-${table.name}`, open, (body) => body.append(
    h("p", { class: "soft small" }, `${table.caption}. `, file("csv", "CSV"), " ", file("md", "Markdown"), " ", file("tex", "LaTeX")), sheet(table))),
  () => rowsLeft(table).length > 0);
}

const table = (name: string) => page.tables.find((t) => t.name === name);

function solvers(): HTMLElement {
  const shown = ["solvers", "failed-runs", "checks", "warnings"];
  const found = shown.map(table).filter((t): t is Table => !!t);
  const failed = table("failed-runs");
  const reasons = failed ? [...new Set(failed.columns.find((c) => c.head === "case")?.words ?? [])] : [];
  const text = failed
    ? `${plural(failed.columns[0].rows.length, "run")} ended early or gave no numbers, in ${list(reasons)}. The table gives the reasons.`
    : "Every run gave all of its numbers.";
  return section("solvers", "Solvers and failed runs", h("p", {}, text),
    ...found.map((t) => tableSection(t, t.name === "solvers" || t.name === "failed-runs")));
}

function commits(): HTMLElement | null {
  if (!page.trends.length) return null;
  const rows = table("over-commits");
  const labels = page.trends.map((t) => t.label);
  return section("commits", "Over commits",
    h("p", { class: "soft" }, "Values are relative to the first commit, over the runs of both commits. A ring marks a step beyond the noise."), steps(),
    h("div", { class: "figures" }, ...MEASURES.map((m) => figure(m.title, labels, () => over(m), "over-commits"))),
    rows ? tableSection(rows) : null);
}

function provenance(): HTMLElement {
  const { program: p, machine: m } = page;
  const facts: [string, string][] = [
    ["version", p.version], ["commit", p.commit + (p.dirty ? ", sources changed since" : "")], ["compiler", p.rustc], ["build profile", p.profile],
    ["built for", `${p.target} (${p.features})`], ["processor", [m.cpu, m.model, m.clock && `${digits(m.clock)} GHz`].filter(Boolean).join(", ")], ["instruction sets", m.instructions], ["threads", String(m.threads)],
  ];
  if (m.load !== null) facts.push(["load at the start", `${m.load}${m.quiet === false ? ": not quiet" : m.quiet ? ": quiet" : ""}`]);
  const terms = (all: [string, string][]) => h("dl", {}, ...all.flatMap(([a, b]) => [h("dt", {}, a), h("dd", {}, b)]));
  return section("provenance", "Provenance", terms(facts),
    page.scenes.length ? folded([`Hashes of the ${page.scenes.length} scene files (BLAKE3)`], "", false, (body) => body.append(terms(page.scenes.map((s) => [s.case, s.blake3])))) : null,
    folded([`${page.figures.length} figures as files, for print`], "", false, (body) => body.append(h("ul", {}, ...page.figures.map(([name, title, csv]) =>
      h("li", {}, `${title}: `, ...["svg", "png", "pdf", ...(csv ? ["csv"] : [])].flatMap((e) => [h("a", { href: `figures/${name}.${e}` }, e.toUpperCase()), " "])))))));
}

function build() {
  document.head.append(h("style", {}, colours()));
  const first = h("section", { id: "question" });
  const topics = page.findings.filter(([title]) => title !== "Locking");
  const claims = topics.filter(([title]) => /claim|Published/.test(title));
  const others = topics.filter((t) => !claims.includes(t));
  const rest = page.tables.filter((t) => !["solvers", "failed-runs", "checks", "warnings", "over-commits", "within"].includes(t.name));
  const parts: (HTMLElement | null)[] = [
    cheapest(),
    section("cases", "Cases", ...page.cases.map(caseSection)),
    locks(),
    page.maps.length ? section("stability", "Where methods bend and break", ...page.maps.map((m) =>
      keep(folded([h("b", {}, m.case), `, ${m.name} `, h("span", { class: "soft small" }, tally(m))], `map-${slug(`${m.case} ${m.name}`)}`, false, (body) => body.append(
        h("p", { class: "soft small" }, `Numbers: ${m.judge}, in per cent. Colours: classes of this error. A method bends if the error is at least twice that at ${m.base}, and is wrong from ${100 * m.wrong} % on.`), mapKey(m), map(m))),
      () => ofCase(m.case) && fits(`${m.case} ${m.name}`, state.find)))) : null,
    solvers(),
    claims.length ? section("claims", "Published claims", ...claims.map(([, all]) => bullets(all))) : null,
    page.tables.length ? section("tables", "Tables", ...rest.map((t) => tableSection(t))) : null,
    commits(),
    others.length ? section("findings", "Further findings", ...others.map(([title, all]) => folded([`${title} `, h("span", { class: "soft small" }, String(all.length))], "", false, (body) => body.append(bullets(all))))) : null,
    provenance(),
  ];
  const shown = parts.filter((p): p is HTMLElement => p !== null);
  const links = shown.map((p) => link(p.id, p.querySelector("h2")!.textContent!));
  main.replaceChildren(header(), first, h("div", { class: "bar" }, h("nav", { "aria-label": "Sections" }, ...links), toolbar()), ...shown);
  question(first);
  const filter = () => filtered.forEach(([element, test]) => { element.hidden = !test(); });
  filter();
  listen((changed) => {
    if (changed.some((k) => ["only", "method", "find"].includes(k))) filter();
    if (changed.includes("at") && state.at) go(state.at);
  });
  if (state.at) go(state.at);
  document.documentElement.dataset.ready = "yes";
}

build();
