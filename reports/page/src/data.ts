// Types of the data that the report embeds in the page; `reports/src/page` writes and describes them.

export interface Look { colour: string; marker: string; dash: number[]; open: boolean; family: string }

export interface Line {
  label: number; run: (number | null)[]; seconds: number[]; spread: (number | null)[]; estimate: (number | null)[]; error: number[]; counts: number[];
}

export interface Ask {
  case: string; title: string; what: string; repeated: boolean; cpu: boolean; time: Axis; error: Axis; scalar: boolean; estimated: boolean; kernels: boolean;
  reference: string | null; band: number | null; rank: (boolean | number)[]; lines: Line[];
}

/** Unit `""` is not written. Positions of `poisson-ratios` are 1/(1 − 2ν), which spreads nearly
 * incompressible materials. */
export interface Axis { name: string; unit: string; log: boolean; shows: "numbers" | "times" | "relative-errors" | "poisson-ratios" }

export interface Curve { label: number; xy: number[]; band?: [number, number, number][]; runs?: number[] }

export interface PlotData { figure: string; case: string; title: string; x: Axis; y: Axis; curves: Curve[] }

export interface Column { head: string; number: boolean; words: string[]; rows: number[]; values?: (number | null)[] }

export interface Table { name: string; title: string; caption: string; note: string; columns: Column[] }

export interface StabilityMap {
  case: string; name: string; unit: string; judge: string; base: string; wrong: number; values: string[]; methods: string[];
  classes: string[]; cells: [number, number, string, number | null, string, number][];
}

export interface Picture { name: string; case: string; title: string; caption: string; svg: string }

export interface Runs {
  id: string[]; case: string[]; method: string[]; label: number[]; poisson: number[]; nodes: number[]; elements: number[];
  dofs: number[]; settings: string[]; solver: string[]; seconds: (number | null)[]; first_use: (number | null)[]; memory: (number | null)[];
  /** Errors by quantity, in their own unit; `1` for relative errors. */
  errors: Record<string, { unit: string; values: (number | null)[] }>;
}

export interface Commit {
  name: string; quiet: boolean | null; runs: number; seconds: number; time: number | null; error: number | null;
  errors_moved: boolean; times_moved: boolean; moved: string; changes: string[];
}

export interface Trend { label: number; commits: Commit[] }

export interface Page {
  source: string;
  program: { version: string; commit: string; dirty: boolean; rustc: string; target: string; features: string; profile: string };
  machine: { cpu: string; model: string; clock: number | null; instructions: string; threads: number; load: number | null; quiet: boolean | null };
  scenes: { case: string; blake3: string; title: string }[];
  records: string;
  study: boolean;
  counts: {
    runs: number; numbers: number; failures: number; partial: number; warnings: number;
    pass: number; fail: number; known: number; not_run: number;
  };
  cases: { name: string; title: string; purpose: string }[];
  looks: Record<string, Look>;
  labels: string[];
  runs: Runs;
  deadlines: [string, string, number][];
  wanted: number;
  floor: number;
  asks: Ask[];
  plots: PlotData[];
  pictures: Picture[];
  figures: [string, string, boolean][];
  maps: StabilityMap[];
  trends: Trend[];
  tables: Table[];
  findings: [string, string[]][];
}

export const page: Page = JSON.parse(document.getElementById("data")!.textContent!);

export const name = (label: number): string => page.labels[label];
export const look = (label: number): Look => page.looks[page.labels[label]];
