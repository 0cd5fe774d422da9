// Tests of the page in a browser: `node test/page.mjs REPORT.html`. Continuous integration tests the page of
// the quick verification.
//
// If no Chromium is installed, the tests are skipped with a message.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { launch } from "./browser.mjs";

const file = process.argv[2];
if (!file) {
  console.error("usage: node test/page.mjs REPORT.html");
  process.exit(2);
}
const url = `file://${resolve(file)}`;
const browser = await launch();
if (!browser) {
  console.log("skipped: no Chromium here (set CHROMIUM to one)");
  // With CI=true, the tests may be skipped only if .ci/skips names chromium.
  const list = readFileSync(new URL("../../../.ci/skips", import.meta.url), "utf8");
  process.exit(process.env.CI === "true" && !/^chromium: /m.test(list) ? 1 : 0);
}

const tests = [];
const test = (name, run) => tests.push([name, run]);
const text = (selector) => `(document.querySelector(${JSON.stringify(selector)})?.innerText ?? "")`;
const all = (selector) => `[...document.querySelectorAll(${JSON.stringify(selector)})]`;
const onFirstScreen = (selector) => `(() => { const r = document.querySelector(${JSON.stringify(selector)})?.getBoundingClientRect(); return !!r && r.top >= 0 && r.top < innerHeight && r.width > 0; })()`;
const click = (selector) => `(() => { const e = document.querySelector(${JSON.stringify(selector)}); if (!e) throw new Error("nothing is " + ${JSON.stringify(selector)}); e.click(); return true; })()`;
const choose = (label, value) => `(() => { const e = document.querySelector('select[aria-label="${label}"]'); e.value = ${JSON.stringify(value)}; e.dispatchEvent(new Event("change")); return e.value; })()`;
const data = 'JSON.parse(document.getElementById("data").textContent)';
const folder = mkdtempSync(join(tmpdir(), "tissuebench-altered-"));

/** The address of the report with changed data. */
function altered(change) {
  const [start, end] = ['<script type="application/json" id="data">', "</script>"];
  const html = readFileSync(resolve(file), "utf8");
  const at = html.indexOf(start) + start.length;
  const last = html.indexOf(end, at);
  const own = JSON.parse(html.slice(at, last));
  change(own);
  const path = join(folder, "report.html");
  writeFileSync(path, html.slice(0, at) + JSON.stringify(own).replaceAll("<", "\\u003c") + html.slice(last));
  return `file://${path}`;
}

test("the first screen asks, answers and draws", async (open) => {
  const page = await open();
  assert.ok(page.seconds < 3, `interactive after ${page.seconds} s`);
  for (const selector of ["h1.question", "#answer", "#front svg"]) assert.ok(await page.eval(onFirstScreen(selector)), selector);
  assert.ok(await page.eval(`${all("#front svg [aria-label=dot] *")}.length > 1`), "no marker is drawn");
  assert.ok(await page.eval(`${all("#front svg .front path, #front svg path.front")}.length > 0`), "no front is drawn");
  assert.match(await page.eval(text("#answer")), /%.*(s|h)[.;, ]/);
  // Addresses of the page itself are not requests.
  assert.deepEqual(page.requests.filter((r) => !r.startsWith("file:") && !r.startsWith("data:")), []);
});

test("every question is answered by the fastest run that counts", async (open) => {
  const page = await open();
  const asks = await page.eval(`${data}.asks.filter((a) => !a.kernels)`);
  const labels = await page.eval(`${data}.labels`);
  for (const ask of asks.slice(0, 12)) {
    await page.eval(`location.hash = ${JSON.stringify(new URLSearchParams({ case: ask.case, what: ask.what, clock: ask.repeated ? "loop" : "once", within: "0.1" }).toString())}`);
    await page.until(`${text("#answer")}.includes(${JSON.stringify(ask.what)}) && ${text("#answer")}.includes(${JSON.stringify(ask.case)})`);
    const first = asks.find((a) => a.case === ask.case && a.what === ask.what && a.repeated === ask.repeated);
    const runs = first.lines.flatMap((l) => l.seconds.map((s, i) => ({ label: labels[l.label], s, counts: l.counts[i] })));
    const best = runs.filter((r) => r.counts <= 0.1).sort((a, b) => a.s - b.s)[0];
    const said = await page.eval(text("#answer"));
    assert.ok(best ? said.includes(`: ${best.label}, `) : said.includes("no run reaches it"), `${said} / ${JSON.stringify(best)}`);
  }
});

test("a number right by chance is no answer", async (open) => {
  const page = await open();
  const asks = await page.eval(`${data}.asks.filter((a) => a.scalar && !a.repeated)`);
  const labels = await page.eval(`${data}.labels`);
  let seen = 0;
  for (const ask of asks)
    for (const within of [0.1, 0.03, 0.01]) {
      const runs = ask.lines.flatMap((l) => l.error.map((e, i) => ({ label: labels[l.label], s: l.seconds[i], e, counts: l.counts[i] })));
      const first = runs.filter((r) => r.e <= within).sort((a, b) => a.s - b.s)[0];
      if (!first || first.counts <= within || runs.some((r) => r.label === first.label && r.counts <= within)) continue;
      seen += 1;
      await page.eval(`location.hash = ${JSON.stringify(new URLSearchParams({ case: ask.case, what: ask.what, within: String(within) }).toString())}`);
      await page.until(`${text("#answer")}.startsWith("${100 * within} % of ${ask.what} on ${ask.case}")`);
      const said = await page.eval(text("#answer"));
      assert.ok(!said.includes(`: ${first.label},`), said);
      const chance = (await page.eval(text("#question"))).split("Right by chance, not counted")[1] ?? "";
      assert.ok(chance.includes(first.label), `${first.label}: ${chance}`);
    }
  console.log(`        ${seen} runs are right by chance`);
});

test("methods are switched off and on, and the answer follows", async (open) => {
  const page = await open();
  const before = await page.eval(text("#answer"));
  const best = (before.match(/Nearest is ([^,]+),/) ?? before.match(/: ([^,]+), /))[1];
  const chip = `.legend button[data-label="${best}"]`;
  const lines = `${all('#front svg [aria-label=line] path')}.length`;
  const drawn = await page.eval(lines);
  await page.eval(click(chip));
  assert.equal(await page.eval(`document.querySelector('${chip}').getAttribute("aria-pressed")`), "false");
  assert.notEqual(await page.eval(text("#answer")), before);
  assert.ok(await page.eval(`${lines} <= ${drawn}`));
  assert.match(await page.eval("location.hash"), /off=/);
  await page.eval(click(chip));
  assert.equal(await page.eval(text("#answer")), before);
});

test("the axis of times names the clock, and the note gives the reason", async (open) => {
  const change = (d) => {
    d.machine.quiet = false;
    d.asks.forEach((a) => { if (!a.repeated) a.time.name = "CPU time, median"; });
  };
  const page = await open("", { at: altered(change) });
  assert.ok((await page.eval(`${all("#front svg text")}.map((t) => t.textContent)`)).includes("CPU time, median"));
  assert.match(await page.eval(text("#question")), /The machine was not quiet: runs are compared by CPU time/);
});

test("hovering shows a run with its record", async (open) => {
  const page = await open();
  const at = await page.eval(`(() => { const r = ${all("#front svg [aria-label=dot] *")}[0].getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()`);
  await page.move(at[0] - 30, at[1]);
  await page.move(at[0], at[1]);
  await page.until(`${text("#front .card")}.includes("nodes")`);
  assert.match(await page.eval(text("#front .card")), /run [0-9a-zA-Z(].* in records\.csv/);
  if (await page.eval(`${data}.study`))
    assert.match(await page.eval(text("#front .card")), /run again by tissuebench reproduce results [0-9a-f]{16}/);
});

test("hovering shows the exact number, however small", async (open) => {
  const page = await open();
  const [at, tiny] = await page.eval(`(() => { const d = ${data}; const k = d.asks.findIndex((a) => !a.kernels && !a.repeated && a.lines.some((l) => l.error.some((e) => e < d.floor))); return [k, k < 0 ? [] : d.asks[k].lines.flatMap((l) => l.error).filter((e) => e < d.floor)]; })()`);
  if (at < 0) return console.log("        no error here is below the least that is drawn");
  const ask = await page.eval(`${data}.asks[${at}]`);
  await page.eval(`location.hash = ${JSON.stringify(new URLSearchParams({ case: ask.case, what: ask.what }).toString())}`);
  await page.until(`${text("#answer")}.includes(${JSON.stringify(ask.case)})`);
  // The lowest marker is drawn at the floor, the smallest error that is drawn.
  const place = await page.eval(`(() => { const all = ${all("#front svg [aria-label=dot] *")}.map((e) => e.getBoundingClientRect()).filter((r) => r.width); const r = all.reduce((a, b) => (b.bottom > a.bottom ? b : a)); return [r.x + r.width / 2, r.y + r.height / 2]; })()`);
  await page.move(place[0] - 5, place[1] - 5);
  await page.move(place[0], place[1]);
  await page.until(`${all("#front svg [aria-label=tip] text")}.length`);
  const said = await page.eval(`${all("#front svg [aria-label=tip] text")}.map((e) => e.textContent).join(" ")`);
  const mantissas = tiny.map((e) => e.toExponential(2).split("e")[0]);
  assert.ok(mantissas.some((m) => said.includes(m)), `${said} / ${tiny}`);
});

test("the cheapest run within the error has its table, case by case", async (open) => {
  const page = await open("#at=within");
  const found = await page.eval(`${data}.tables.find((t) => t.name === "within")`);
  assert.ok(found, "no table");
  await page.until(`${all("#within tbody tr")}.length`);
  const rows = await page.eval(`${all("#within tbody tr")}.map((r) => [...r.cells].map((c) => c.innerText))`);
  // A method that reaches the error has a time, and a method that never reaches it has "not reached".
  for (const [method, reached, ...cells] of rows) {
    const times = cells.filter((c) => /^[\d.]/.test(c)).length;
    assert.equal(times, Number(reached.split(" ")[0]), `${method}: ${reached} / ${cells}`);
    assert.ok(times || cells.includes("not reached"), `${method}: ${cells}`);
  }
});

test("no two series of a figure look alike", async (open) => {
  const page = await open();
  const alike = await page.eval(`(() => { const d = ${data}; const out = []; const see = (title, labels) => { const looks = new Map(); for (const l of new Set(labels)) { const k = JSON.stringify([d.looks[d.labels[l]].colour, d.looks[d.labels[l]].marker, d.looks[d.labels[l]].dash, d.looks[d.labels[l]].open]); if (looks.has(k)) out.push([title, d.labels[l], looks.get(k)]); looks.set(k, d.labels[l]); } }; d.asks.forEach((a) => see(a.title, a.lines.map((l) => l.label))); d.plots.forEach((p) => see(p.title, p.curves.map((c) => c.label))); return out; })()`);
  assert.deepEqual(alike, []);
});

test("filters hold for the whole page and live in the address", async (open) => {
  const first = await open();
  const [name, method] = await first.eval(`(() => { const d = ${data}; const a = d.asks[0]; return [a.case, d.labels[a.lines[0].label]]; })()`);
  const page = await open(`#only=${encodeURIComponent(name)}&method=${encodeURIComponent(method)}`);
  assert.deepEqual(await page.eval(`${all("#cases > details")}.filter((d) => !d.hidden).map((d) => d.querySelector("b").innerText)`), [name]);
  assert.equal(await page.eval('document.getElementById("filter-method").value'), method);
  await page.eval(`document.querySelector("#tables details:not([hidden])").open = true`);
  await page.until(`${all("#tables tbody tr")}.length`);
  const rows = await page.eval(`(() => { const t = document.querySelector("#tables .sheet table"); const k = [...t.querySelectorAll("th")].findIndex((h) => h.innerText.trim() === "case"); return [...t.querySelectorAll("tbody tr")].map((r) => r.cells[k]?.innerText); })()`);
  assert.ok(rows.length && rows.every((r) => r === undefined || r === name), JSON.stringify(rows));
  // An empty address removes the filters.
  await page.eval(`location.hash = ""`);
  await page.until(`${all("#cases > details")}.filter((d) => !d.hidden).length > 1 || ${data}.cases.length === 1`);
});

test("a table sorts both ways and is copied", async (open) => {
  const page = await open("#at=table-timing");
  const column = `(() => { const t = document.querySelector("#table-timing table"); const h = [...t.querySelectorAll("th")]; const k = h.findIndex((x) => x.classList.contains("n")); return [k, [...t.querySelectorAll("tbody tr")].map((r) => parseFloat(r.cells[k].innerText))]; })()`;
  await page.until(`${all("#table-timing tbody tr")}.length > 1`);
  const sorted = (v, down) => v.every((x, i) => !i || Number.isNaN(x) || Number.isNaN(v[i - 1]) || (down ? v[i - 1] >= x : v[i - 1] <= x));
  const [k] = await page.eval(column);
  const head = `#table-timing th:nth-child(${k + 1}) button`;
  await page.eval(click(head));
  assert.ok(sorted((await page.eval(column))[1], false));
  await page.eval(click(head));
  const [, down] = await page.eval(column);
  assert.ok(sorted(down, true) && down[0] >= down[down.length - 1]);
  assert.equal(await page.eval(`document.querySelector("#table-timing th:nth-child(${k + 1})").getAttribute("aria-sort")`), "descending");
  await page.eval(`navigator.clipboard.writeText = async (t) => { window.copied = t; }`);
  for (const [k, start] of [[1, /^case,/], [2, /^\| case \|/], [3, /^% needs/]]) {
    await page.eval(`${all("#table-timing .tools button")}[${k - 1}].click()`);
    await page.until("window.copied");
    assert.match(await page.eval("window.copied"), start);
    await page.eval("window.copied = ''");
  }
});

test("copied CSV has no formulas", async (open) => {
  const words = ["=1+1", "+cmd", "-2+3", "@SUM(A1)", "'=1", "-1.5e-3", "plain, with a comma"];
  const column = (head) => ({ head, number: false, words, rows: words.map((_, k) => k) });
  const made = { name: "made", title: "Made", caption: "Made", note: "", columns: [column("text"), column("again")] };
  const page = await open("#at=table-made", { at: altered((d) => { d.tables.push(made); }) });
  await page.until(`${all("#table-made tbody tr")}.length`);
  await page.eval(`navigator.clipboard.writeText = async (t) => { window.copied = t; }`);
  await page.eval(`${all("#table-made .tools button")}[0].click()`);
  await page.until("window.copied");
  const cells = ["'=1+1", "'+cmd", "'-2+3", "'@SUM(A1)", "''=1", "-1.5e-3", '"plain, with a comma"'];
  assert.deepEqual((await page.eval("window.copied")).trim().split("\n").slice(1), cells.map((c) => `${c},${c}`));
});

test("two clicks reach the sections on locking and on failed runs", async (open) => {
  const page = await open();
  const links = await page.eval(`${all("nav a")}.map((a) => a.innerText)`);
  for (const [word, id] of [["Locking", "locking"], ["failed", "solvers"]]) {
    const k = links.findIndex((l) => l.includes(word));
    if (k < 0) continue;
    await page.eval(`${all("nav a")}[${k}].click()`);
    await page.until(`document.getElementById("${id}").getBoundingClientRect().top < innerHeight / 2`);
    assert.ok((await page.eval(`document.getElementById("${id}").innerText.length`)) > 60, id);
  }
  const counts = await page.eval(`${data}.counts`);
  const header = await page.eval(text("header"));
  assert.match(header, counts.failures ? /without a result/ : counts.partial ? /part of the load/ : /no run failed/);
});

test("the first screen and two clicks answer a stranger", async (open) => {
  const page = await open();
  // Which method is cheapest: the sentence gives its size and its time, or says that no run reaches the
  // error.
  const said = await page.eval(text("#answer"));
  assert.match(said, /^\d+ % of .+: ([^,]+, [\d,]+ nodes, [\d.]+ (ns|µs|ms|s|h)[;.]|no run reaches it)/);
  // The main case, if its front is in the results: the force of the jaws on the fair kidney.
  const flagship = await page.eval(`${data}.asks.some((a) => /^kidney-fair/.test(a.case) && a.what === "tool force" && !a.repeated)`);
  if (flagship) assert.match(said, /^5 % of tool force on kidney-fair.*: (?!no run)/);
  else console.log("        no front of the fair kidney in these results");
  // Whether any solver fails: the header says so, and one click leads to the reasons.
  const counts = await page.eval(`${data}.counts`);
  const failing = counts.failures + counts.partial;
  const link = await page.eval(`${all("header a")}.find((a) => /without a result|part of the load|no run failed/.test(a.innerText))?.innerText`);
  assert.equal(link, failing ? (counts.failures ? `${counts.failures} run${counts.failures === 1 ? "" : "s"} without a result` : `${counts.partial} run${counts.partial === 1 ? "" : "s"} with only part of the load`) : "no run failed");
  await page.eval(`${all("header a")}.find((a) => a.innerText === ${JSON.stringify(link)}).click()`);
  await page.until(`document.getElementById("solvers").getBoundingClientRect().top < innerHeight / 2`);
  if (failing) {
    const reasons = await page.eval(`(() => { const t = ${data}.tables.find((t) => t.name === "failed-runs"); return t.columns.find((c) => /why|reason/.test(c.head)).words; })()`);
    const shown = await page.eval(text("#solvers"));
    assert.ok(reasons.some((r) => r && shown.includes(r.trim())), "no reason in sight");
  } else assert.match(await page.eval(text("#solvers")), /Every run gave all of its numbers/);
  // Which methods lock: one click leads to their names and errors.
  const locking = await page.eval(`${data}.findings.find(([t]) => t === "Locking")?.[1].find((s) => s.includes("more than doubles")) ?? ""`);
  if (!locking) return console.log("        nothing locks in these results");
  await page.eval(`${all("nav a")}.find((a) => a.innerText.includes("Locking")).click()`);
  await page.until(`document.getElementById("locking").getBoundingClientRect().top < innerHeight / 2`);
  const shown = await page.eval(text("#locking"));
  const method = locking.match(/more than doubles with ([^ ,.]+)/)[1];
  assert.ok(shown.includes(method) && /ν = 0\.3 to 0\.49/.test(shown), shown.slice(0, 300));
});

test("a study over commits has its steps ringed and listed", async (open) => {
  const page = await open("#at=commits");
  const trends = await page.eval(`${data}.trends`);
  if (!trends.length) return console.log("        this report has no history");
  await page.until(`${all("#commits svg.plot, #commits .plot svg")}.length === 2`);
  const moved = trends.flatMap((t) => t.commits).filter((c) => c.moved);
  const told = await page.eval(text("#commits"));
  assert.ok(moved.length ? moved.every((c) => told.includes(c.name) && told.includes(c.moved)) : told.includes("No step is beyond the noise"), told.slice(0, 400));
  const rings = await page.eval(`${all("#commits [aria-label=dot][stroke='var(--accent)'] *")}.length`);
  assert.equal(rings, moved.reduce((n, c) => n + c.errors_moved + c.times_moved, 0));
});

test("a history shows labels whole, and commits by seven digits", async (open) => {
  const names = ["0123456789ab+", "before-projection", "the branch with a label of many words"];
  const commit = (name) => ({ name, quiet: true, runs: 1, seconds: 1, time: 1, error: 1, errors_moved: false, times_moved: false, moved: "", changes: [] });
  const page = await open("#at=commits", { at: altered((d) => { d.trends = [{ label: 0, commits: names.map(commit) }]; }) });
  await page.until(`${all("#commits svg.plot, #commits .plot svg")}.length`);
  const shown = await page.eval(`${all("#commits svg text")}.map((t) => t.textContent)`);
  for (const name of ["0123456", "before-projection", "the branch with a label…"]) assert.ok(shown.includes(name), `${name}: ${shown}`);
});

test("keys reach the question, the methods, the plot and every section", async (open) => {
  const page = await open();
  const reached = new Set();
  for (let k = 0; k < 60; k++) {
    await page.press("Tab");
    reached.add(await page.eval(`(() => { const e = document.activeElement; return e.tagName + (e.className.baseVal ?? e.className) + (e.getAttribute("aria-label") ?? ""); })()`));
  }
  const has = (word) => assert.ok([...reached].some((r) => r.includes(word)), `${word} is not reached: ${[...reached].join("; ")}`);
  ["SELECTquantity", "BUTTONchip", "DIVchart", "Methods shown", "SUMMARY"].forEach(has);
  await page.eval(`document.querySelector("#front .chart").focus()`);
  await page.press("ArrowRight");
  await page.until(`${text("#front .card")}.includes("nodes") && document.querySelector("#front .reached")`);
  await page.eval(`document.querySelector("#cases summary").focus()`);
  await page.press("Enter");
  await page.until(`document.querySelector("#cases details").open`);
});

test("bodies are drawn in three dimensions, moved, cut and compared", async (open) => {
  const probe = await open();
  const found = await probe.eval(`${all("script[id^=bodies-]")}.map((e) => e.id.slice(7))`);
  if (!found.length) return console.log("        this report has no bodies");
  // The first case with curved faces, if there is any.
  const curved = await probe.eval(`${all("script[id^=bodies-]")}.find((e) => JSON.parse(e.textContent).some((b) => b.faces.some((f) => f.nodes > 4)))?.id.slice(7)`);
  const name = curved ?? found[0];
  const page = await open(`#at=case-${name.toLowerCase().replace(/[^a-z0-9]+/g, "-")}`);
  assert.equal(await page.eval("typeof window.showBodies"), "undefined", "it is evaluated when asked for");
  await page.eval(`${all("details[open] button")}.find((b) => b.innerText.includes("three dimensions")).click()`);
  await page.until("document.querySelector('.solid canvas')");
  // The number of coarse colours of the picture, and a checksum of its pixels.
  const seen = `(() => { const c = document.querySelector(".solid canvas"); const d = document.createElement("canvas"); d.width = 200; d.height = 120; const g = d.getContext("2d"); g.drawImage(c, 0, 0, 200, 120); const p = g.getImageData(0, 0, 200, 120).data; const n = new Set(); let sum = 0; for (let k = 0; k < p.length; k += 4) { if (p[k + 3] > 0) { n.add(p[k] >> 4 << 8 | p[k + 1] >> 4 << 4 | p[k + 2] >> 4); sum = (sum * 31 + p[k] + 7 * p[k + 1] + k) % 1e9; } } return [n.size, sum]; })()`;
  const [colours, before] = await page.eval(seen);
  assert.ok(colours > 15, `${colours} colours: it is blank`);
  const pick = (label, value) => page.eval(`(() => { const e = document.querySelector('.solid select[aria-label="${label}"]'); e.value = ${value}; e.dispatchEvent(new Event("change")); })()`);
  const changed = async (what, was) => { const [, now] = await page.eval(seen); assert.notEqual(now, was, `${what} changes nothing`); return now; };
  const body = await page.eval(`JSON.parse(document.getElementById(${JSON.stringify(`bodies-${name}`)}).textContent)[0]`);
  let was = before;
  if (body.states.some((s) => s.values)) { await pick("field", "'p'"); was = await changed("the field", was); }
  await pick("cut", "'y'"); was = await changed("the cut", was);
  if (body.inside) assert.ok(Number(await page.eval("document.querySelector('.solid canvas').dataset.cut")) > 10, "the cut is open");
  await pick("cut", "''"); was = await changed("the whole", was);
  const middle = await page.eval(`(() => { const e = document.querySelector(".solid canvas"); e.scrollIntoView({ block: "center" }); const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()`);
  await page.move(middle[0] - 9, middle[1]);
  await page.move(middle[0], middle[1]);
  await page.until(`/at .+ mm$/.test(${text(".solid .here")})`);
  if (body.states.length > 1) {
    await page.eval(`(() => { const e = document.querySelector('.solid input[aria-label="load step"]'); e.value = 0; e.dispatchEvent(new Event("input")); })()`);
    was = await changed("the load step", was);
  }
  // The page shows the number of contact points and the depth of the deepest point.
  const touches = await page.eval(`(() => { const m = document.querySelector('.solid select[aria-label="body"]').value; const b = JSON.parse(document.getElementById(${JSON.stringify(`bodies-${name}`)}).textContent).find((b) => b.method === m); const t = new Float32Array(Uint8Array.from(atob(b.states[b.states.length - 1].touching), (c) => c.charCodeAt(0)).buffer); return [...t].filter((_, k) => k % 4 === 3); })()`);
  if (touches.length) {
    await page.eval(`(() => { const e = document.querySelector('.solid input[aria-label="load step"]'); if (e) { e.value = 1; e.dispatchEvent(new Event("input")); } })()`);
    await pick("field", "'d'"); was = await changed("the depth of contact points", was);
    const [, count, deepest] = (await page.eval(text(".solid"))).match(/acts at (\d+) points \(marked\), at most ([\d.e-]+) mm deep/);
    assert.equal(Number(count), touches.length);
    assert.ok(Math.abs(Number(deepest) / (1e3 * Math.max(...touches)) - 1) < 0.06, deepest);
    await page.eval(`${all(".solid label")}.find((l) => l.innerText.includes("contact points")).querySelector("input").click()`);
  }
  const fields = await page.eval(`${all('.solid select[aria-label="field"] option')}.map((o) => o.value)`);
  if (fields.includes("e")) {
    await pick("field", "'e'"); was = await changed("the difference to the reference", was);
    // The difference gives the surface several colours.
    assert.ok((await page.eval(seen))[0] > 15);
  }
  // The nodes of a cloud appear on request.
  const cloud = await page.eval(`JSON.parse(document.getElementById(${JSON.stringify(`bodies-${name}`)}).textContent).find((b) => b.cloud)?.method ?? ""`);
  if (cloud) {
    const first = await page.eval(`document.querySelector('.solid select[aria-label="body"]').value`);
    await pick("body", JSON.stringify(cloud)); was = (await page.eval(seen))[1];
    const box = `${all(".solid label")}.find((l) => l.innerText.includes("nodes of clouds")).querySelector("input")`;
    await page.eval(`${box}.click()`); was = await changed("a cloud's nodes", was);
    await page.eval(`${box}.click()`);
    await pick("body", JSON.stringify(first)); was = (await page.eval(seen))[1];
  }
  const triangles = Number(await page.eval("document.querySelector('.solid canvas').dataset.triangles"));
  await pick("second body", "e.options[e.options.length - 1].value");
  was = await changed("the second body", was);
  assert.ok(Number(await page.eval("document.querySelector('.solid canvas').dataset.triangles")) > triangles);
  if (curved) {
    // A curved face is drawn in at least 5 x 5 triangles.
    const faces = await page.eval(`(() => { const m = document.querySelector('.solid select[aria-label="body"]').value; const b = JSON.parse(document.getElementById(${JSON.stringify(`bodies-${name}`)}).textContent).find((b) => b.method === m); return b.faces.reduce((n, f) => n + atob(f.indices).length / 4 / f.nodes, 0); })()`);
    assert.ok(triangles >= 25 * faces * 0.9, `${triangles} triangles of ${faces} faces`);
  }
});

test("a phone's width needs no scrolling sideways", async (open) => {
  const page = await open("", { width: 390, height: 844 });
  await page.eval(`${all("details")}.slice(0, 8).forEach((d) => { d.open = true; })`);
  await new Promise((done) => setTimeout(done, 600));
  const wide = await page.eval(`[document.documentElement.scrollWidth, innerWidth]`);
  assert.ok(wide[0] <= 390, `${wide}`);
  for (const selector of ["h1.question", "#answer", "#front svg"]) assert.ok(await page.eval(onFirstScreen(selector)), selector);
});

test("dark mode is dark, and print keeps the front", async (open) => {
  const page = await open("", { dark: true });
  const brightness = `(() => { const c = getComputedStyle(document.body).backgroundColor.match(/[\\d.]+/g).map(Number); return c[0] + c[1] + c[2]; })()`;
  assert.ok((await page.eval(brightness)) < 150);
  await page.send("Emulation.setEmulatedMedia", { media: "print", features: [{ name: "prefers-color-scheme", value: "dark" }] });
  assert.ok((await page.eval(brightness)) > 600, "a dark page is printed light");
  assert.ok(await page.eval(`document.querySelector("#front svg").getBoundingClientRect().height > 100`));
  await page.send("Emulation.setDeviceMetricsOverride", { width: 794, height: 1123, deviceScaleFactor: 1, mobile: false });
  assert.ok(await page.eval("document.documentElement.scrollWidth") <= 794, "a table is wider than the paper");
  const { data: pdf } = await page.send("Page.printToPDF", {});
  assert.ok(pdf.length > 10000);
  const undrawn = await page.eval(`${all("figure")}.filter((f) => f.checkVisibility() && !f.querySelector("svg.plot, .plot svg, .picture svg")).length`);
  assert.equal(undrawn, 0, "figures without a plot on paper");
});

let failed = 0;
for (const [name, run] of tests) {
  const opened = [];
  const open = async (hash = "", options = {}) => {
    const page = await browser.open((options.at ?? url) + hash, options);
    opened.push(page);
    return page;
  };
  try {
    await run(open);
    for (const page of opened) assert.deepEqual(page.errors, [], "errors on the console");
    console.log(`ok      ${name}`);
  } catch (bad) {
    failed += 1;
    console.log(`FAILED  ${name}\n        ${bad.message.slice(0, 1500)}`);
  }
  for (const page of opened) await page.close();
}
await browser.close();
rmSync(folder, { recursive: true });
console.log(failed ? `${failed} of ${tests.length} failed` : `${tests.length} passed`);
process.exit(failed ? 1 : 0);
