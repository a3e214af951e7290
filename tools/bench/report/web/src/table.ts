// Tables that sort by a click on a column's head, and copy themselves as LaTeX, CSV and Markdown.
import { make, say } from "./dom";

type Format = "LaTeX" | "CSV" | "Markdown";

const textOf = (cell: Element): string => (cell.textContent ?? "").trim();

// A number where the cell begins with one: "0.012 [0.010, 0.013]" sorts by the first. What is none comes last.
export function sortKey(text: string): number {
  const found = text.replace("−", "-").match(/^[<>=≤≥ ]*(-?\d[\d.]*(?:e[-+]?\d+)?)/i);
  return found ? Number(found[1]) : NaN;
}

export function compare(a: string, b: string): number {
  const [x, y] = [sortKey(a), sortKey(b)];
  if (Number.isNaN(x) && Number.isNaN(y)) return a.localeCompare(b);
  if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) ? 1 : -1;
  return x - y;
}

const latex = (text: string): string =>
  text
    .replace(/[\\_%&#${}~^<>]/g, (c) => ({ "\\": "\\textbackslash{}", "~": "\\textasciitilde{}", "^": "\\textasciicircum{}", "<": "\\textless{}", ">": "\\textgreater{}" })[c] ?? `\\${c}`)
    .replace(/²/g, "\\textsuperscript{2}")
    .replace(/°/g, "\\textdegree{}")
    .replace(/σ/g, "$\\sigma$")
    .replace(/–/g, "--")
    .replace(/…/g, "\\dots{}")
    .replace(/−/g, "$-$");

const csv = (text: string): string => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);

export function write(rows: string[][], format: Format): string {
  const [head = [], ...body] = rows;
  switch (format) {
    case "CSV":
      return rows.map((row) => row.map(csv).join(",") + "\n").join("");
    case "Markdown": {
      const line = (row: string[]) => `| ${row.map((cell) => cell.replace(/\|/g, "\\|")).join(" | ")} |\n`;
      return line(head) + `|${head.map((_, k) => (k === 0 ? "---" : "---:")).join("|")}|\n` + body.map(line).join("");
    }
    case "LaTeX": {
      const line = (row: string[]) => `${row.map(latex).join(" & ")} \\\\\n`;
      const columns = head.map((_, k) => (k === 0 ? "l" : "r")).join("");
      return `\\begin{tabular}{${columns}}\n\\hline\n${line(head)}\\hline\n${body.map(line).join("")}\\hline\n\\end{tabular}\n`;
    }
  }
}

async function copy(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Where a page may not use the clipboard by itself, the old way is there yet.
    const area = make("textarea", { class: "unseen" });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    if (!done) throw new Error("this browser does not let pages copy");
  }
}

export function enhance(holder: HTMLElement): void {
  const table = holder.querySelector("table");
  const body = table?.tBodies[0];
  if (!table || !body) return;
  const heads = [...table.querySelectorAll("thead th")];
  heads.forEach((head, column) => {
    const button = make("button", { type: "button", title: "Sort" }, textOf(head) || "#");
    button.addEventListener("click", () => {
      const falls = head.getAttribute("aria-sort") === "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", falls ? "descending" : "ascending");
      const rows = [...body.rows];
      const key = (row: HTMLTableRowElement) => textOf(row.cells[column] ?? row);
      rows.sort((a, b) => {
        const missing = Number(Number.isNaN(sortKey(key(a)))) - Number(Number.isNaN(sortKey(key(b))));
        return missing !== 0 ? missing : (falls ? -1 : 1) * compare(key(a), key(b));
      });
      body.append(...rows);
      say(`Sorted by ${textOf(head)}, ${falls ? "falling" : "rising"}`);
    });
    head.replaceChildren(button);
  });
  const buttons = make("div", { class: "tools", role: "group", "aria-label": "Copy this table" }, "Copy as ");
  for (const format of ["LaTeX", "CSV", "Markdown"] as const) {
    const button = make("button", { type: "button" }, format);
    button.addEventListener("click", () => {
      const rows = [...table.rows].map((row) => [...row.cells].map(textOf));
      copy(write(rows, format)).then(
        () => say(`The table is copied as ${format}`),
        (error: unknown) => say(`Not copied: ${String(error)}`),
      );
      button.classList.add("done");
      setTimeout(() => button.classList.remove("done"), 1500);
    });
    buttons.append(button);
  }
  holder.append(buttons);
}
