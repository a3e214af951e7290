// Tables that sort by a click on a column's head, and copy themselves as LaTeX, CSV and Markdown.

/** @type {(cell?: Element) => string} */
const cellText = (cell) => (cell?.textContent ?? "").trim();

/** The number that a cell begins with: "0.012 [0.010, 0.013]" sorts by 0.012. @type {(text: string) => number} */
const sortKey = (text) => Number(text.replace("−", "-").match(/^[<>=≤≥ ]*(-?\d[\d.]*(e[-+]?\d+)?)/i)?.[1] ?? NaN);

/** @type {Record<string, string>} */
const kLatex = {
  "\\": "\\textbackslash{}",
  "~": "\\textasciitilde{}",
  "^": "\\textasciicircum{}",
  "<": "\\textless{}",
  ">": "\\textgreater{}",
  "²": "\\textsuperscript{2}",
  "°": "\\textdegree{}",
  σ: "$\\sigma$",
  "–": "--",
  "…": "\\dots{}",
  "−": "$-$",
};

/** @typedef {{cell: (text: string) => string, line: (cells: string[]) => string, rule: (columns: number) => string,
 *             begin?: (columns: number) => string, end?: string}} Format  `rule` stands below the head */
/** @type {Record<string, Format>} */
const kFormats = {
  LaTeX: {
    cell: (text) => text.replace(/[\\_%&#${}~^<>²°σ–…−]/g, (c) => kLatex[c] ?? `\\${c}`),
    line: (cells) => `${cells.join(" & ")} \\\\\n`,
    begin: (columns) => `\\begin{tabular}{l${"r".repeat(columns - 1)}}\n\\hline\n`,
    rule: () => "\\hline\n",
    end: "\\hline\n\\end{tabular}\n",
  },
  CSV: {
    cell: (text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text),
    line: (cells) => `${cells.join(",")}\n`,
    rule: () => "",
  },
  Markdown: {
    cell: (text) => text.replace(/\|/g, "\\|"),
    line: (cells) => `| ${cells.join(" | ")} |\n`,
    rule: (columns) => `|---${"|---:".repeat(columns - 1)}|\n`,
  },
};

/** @type {(rows: string[][], format: Format) => string} */
function written([head, ...body], { cell, line, rule, begin, end }) {
  /** @type {(row: string[]) => string} */
  const write = (row) => line(row.map(cell));
  return (begin?.(head.length) ?? "") + write(head) + rule(head.length) + body.map(write).join("") + (end ?? "");
}

/** @type {(text: string) => Promise<void>} */
async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // The older interface works where a page may not use the clipboard by itself.
    const area = make("textarea", { class: "unseen" });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    if (!done) throw new Error("this browser does not let pages copy");
  }
}

/** @type {(holder: Element) => void} */
function enhance(holder) {
  const table = holder.querySelector("table");
  const body = table?.tBodies[0];
  if (!table || !body) return;
  const heads = [...table.querySelectorAll("thead th")];
  heads.forEach((head, column) => {
    const sort = () => {
      const falls = head.getAttribute("aria-sort") === "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", falls ? "descending" : "ascending");
      const rows = [...body.rows].map((row) => ({ row, text: cellText(row.cells[column]) }));
      rows.sort((a, b) => {
        const [x, y] = [sortKey(a.text), sortKey(b.text)];
        const order = x - y || a.text.localeCompare(b.text);
        return Number(isNaN(x)) - Number(isNaN(y)) || (falls ? -order : order); // no number: last in both directions
      });
      body.append(...rows.map(({ row }) => row));
      say(`Sorted by ${cellText(head)}, ${falls ? "falling" : "rising"}`);
    };
    head.replaceChildren(makeButton(sort, { title: "Sort" }, cellText(head) || "#"));
  });
  const buttons = make("div", { class: "tools", role: "group", "aria-label": "Copy this table" }, "Copy as ");
  for (const [name, format] of Object.entries(kFormats)) {
    const press = () => {
      const rows = [...table.rows].map((row) => [...row.cells].map(cellText));
      copy(written(rows, format)).then(
        () => say(`The table is copied as ${name}`),
        (error) => say(`Not copied: ${error}`),
      );
      button.classList.add("done");
      setTimeout(() => button.classList.remove("done"), 1500);
    };
    const button = makeButton(press, {}, name);
    buttons.append(button);
  }
  holder.append(buttons);
}
