// Tables that can be sorted, filtered, and copied as CSV, Markdown or LaTeX.

import type { Column, Table } from "./data";
import { h } from "./dom";
import { fits, listen, state } from "./state";
import { plural, whole } from "./text";

const SHOWN = 100;
const WHO = ["method", "series", "source", "label"];

/** Indices of the rows that pass the page's filters. */
export function rowsLeft(table: Table): number[] {
  const rows = table.columns[0]?.rows.length ?? 0;
  const text = (heads: string[]) => table.columns.filter((c) => heads.includes(c.head));
  const [cases, methods] = [text(["case"]), text(WHO)];
  const cell = (column: Column, row: number) => column.words[column.rows[row]];
  const joined = (columns: Column[], row: number) => columns.map((c) => cell(c, row)).join(" ");
  const out: number[] = [];
  for (let row = 0; row < rows; row++) {
    const kept = (!state.only || !cases.length || joined(cases, row) === state.only)
      && (!state.method || !methods.length || fits(joined(methods, row), state.method))
      && (!state.find || fits(joined(table.columns, row), state.find));
    if (kept) out.push(row);
  }
  return out;
}

const texts = (table: Table, rows: number[], exact: boolean): string[][] =>
  rows.map((row) => table.columns.map((c) => (exact && c.values ? String(c.values[row] ?? "") : c.words[c.rows[row]])));

/** Text of a CSV cell. As in the tables' files, an apostrophe precedes text that a spreadsheet would run as a
 * formula. */
const guarded = (t: string) => (/^'*[=+\-@\t\r]/.test(t) && !/^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(t) ? `'${t}` : t);

const csv = (rows: string[][]): string =>
  rows.map((row) => row.map(guarded).map((t) => (/[",\r\n]/.test(t) ? `"${t.replace(/"/g, '""')}"` : t)).join(",")).join("\n") + "\n";

function markdown(table: Table, rows: string[][]): string {
  const line = (cells: string[]) => `| ${cells.map((t) => t.replace(/[\\|*_`[\]#]/g, "\\$&").replace(/</g, "&lt;")).join(" | ")} |\n`;
  const rule = `| ${table.columns.map((c) => (c.number ? "---:" : "---")).join(" | ")} |\n`;
  return line(table.columns.map((c) => c.head)) + rule + rows.map(line).join("");
}

function latex(table: Table, rows: string[][]): string {
  const special: Record<string, string> = { "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}",
    "—": "---", "×": "$\\times$", "±": "$\\pm$", "ν": "$\\nu$", "κ": "$\\kappa$", "µ": "$\\mu$", "<": "\\textless{}", ">": "\\textgreater{}", "|": "\\textbar{}" };
  const powers = (t: string) => t.replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+/g, (p) => `$^{${p.replace(/./g, (c) => (c === "⁻" ? "-" : String("⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c))))}}$`);
  const safe = (t: string) => powers(t.replace(/[\\~^—×±νκµ<>|]|[&%$#_{}]/g, (c) => special[c] ?? `\\${c}`));
  const line = (cells: string[]) => `${cells.map(safe).join(" & ")} \\\\\n`;
  const columns = table.columns.map((c) => (c.number ? "r" : "l")).join("");
  return `% needs \\usepackage{booktabs}\n\\begin{tabular}{${columns}}\n\\toprule\n${line(table.columns.map((c) => c.head))}\\midrule\n${rows.map(line).join("")}\\bottomrule\n\\end{tabular}\n`;
}

async function copy(text: string) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = h("textarea", {}, text);
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
}

/** Table with buttons that sort and copy it. */
export function sheet(table: Table): HTMLElement {
  let sorted: { column: number; down: boolean } | null = null;
  let all = false;
  const made = h("div", { class: "sheet", "data-table": table.name });
  const rows = () => {
    const left = rowsLeft(table);
    if (!sorted) return left;
    const { words, rows, values } = table.columns[sorted.column];
    const by = (a: number, b: number) => {
      if (!values) return words[rows[a]].localeCompare(words[rows[b]], "en", { numeric: true });
      // Missing values come last in both directions.
      const [x, y] = [values[a], values[b]];
      return x === null || y === null ? (Number(x === null) - Number(y === null)) * (sorted!.down ? -1 : 1) : x - y;
    };
    return left.sort((a, b) => (sorted!.down ? -by(a, b) : by(a, b)));
  };
  const draw = () => {
    const kept = rows();
    const shown = all ? kept : kept.slice(0, SHOWN);
    const head = table.columns.map((c, k) => h("th", { scope: "col", class: c.number ? "n" : "", "aria-sort": sorted?.column === k ? (sorted.down ? "descending" : "ascending") : "none" },
      h("button", { type: "button", click: () => { sorted = { column: k, down: sorted?.column === k && !sorted.down }; draw(); } },
        c.head, sorted?.column === k ? (sorted.down ? " ↓" : " ↑") : "")));
    const body = shown.map((row) => h("tr", {}, ...table.columns.map((c) => {
      const text = c.words[c.rows[row]];
      return h("td", { class: c.number ? "n" : text.length > 60 ? "long" : text.length > 24 ? "mid" : "" }, text);
    })));
    const total = table.columns[0].rows.length;
    const said = h("span", { class: "soft small" }, kept.length === total ? plural(total, "row") : `${whole(kept.length)} of ${plural(total, "row")}`);
    const button = (text: string, make: () => string) => {
      const made = h("button", { type: "button", class: "quiet" }, text);
      made.addEventListener("click", async () => { await copy(make()); made.textContent = "copied"; setTimeout(() => (made.textContent = text), 1200); });
      return made;
    };
    const heads = table.columns.map((c) => c.head);
    const more = shown.length < kept.length && h("button", { type: "button", class: "quiet", click: () => { all = true; draw(); } }, `Show all ${whole(kept.length)} rows`);
    made.replaceChildren(
      h("div", { class: "tools" }, said, h("span", { class: "soft small" }, "copy as"),
        button("CSV", () => csv([heads, ...texts(table, rows(), true)])), button("Markdown", () => markdown(table, texts(table, rows(), false))),
        button("LaTeX", () => latex(table, texts(table, rows(), false)))),
      h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": table.title },
        h("table", {}, h("thead", {}, h("tr", {}, ...head)), h("tbody", {}, ...body))),
      ...(more ? [more] : []), ...(table.note ? [h("p", { class: "soft small" }, table.note)] : []));
  };
  draw();
  listen((changed) => {
    if (made.isConnected && changed.some((key) => ["only", "method", "find"].includes(key))) draw();
  });
  return made;
}
