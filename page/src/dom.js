// Elements, tables with their CSV, text to copy.

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value != null) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child != null));
  return node;
}

// Shortest form that people read; every digit stays in data-v.
export function shown(value, digits = 3) {
  if (value == null || Number.isNaN(value)) return "n/a";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(Math.max(0, digits - 1));
  if (size >= 100) return value.toFixed(0);
  return value.toPrecision(digits);
}

export function percentOf(ratio) {
  const change = 100 * (ratio - 1);
  const text = Math.abs(change) >= 10 ? change.toFixed(0) : change.toFixed(1);
  return `${change > 0 ? "+" : ""}${text} %`;
}

// "+73 % [+66, +81]"
export function changeText(change) {
  if (!change) return "n/a";
  const text = percentOf(change.ratio);
  if (change.low == null) return text;
  return `${text} [${percentOf(change.low).slice(0, -2)}, ${percentOf(change.high).slice(0, -2)}]`;
}

function cellOf(row, column) {
  const value = row[column.id];
  const text = column.text ? column.text(value, row) : typeof value === "number" ? shown(value) : value ?? "n/a";
  const attributes = { class: typeof value === "number" ? "n" : null };
  if (typeof value === "number") attributes["data-v"] = String(value);
  if (column.style) attributes.style = column.style(value, row);
  return element("td", attributes, text);
}

// `columns`: {id, title, text?, style?}; rows are objects.
export function table(name, columns, rows) {
  const head = element(
    "tr",
    {},
    ...columns.map(({ id, title }) =>
      element("th", { scope: "col", "data-id": id, class: typeof rows[0]?.[id] === "number" ? "n" : null }, title),
    ),
  );
  const body = rows.map((row) => element("tr", {}, ...columns.map((column) => cellOf(row, column))));
  const node = element(
    "table",
    {},
    element("caption", {}, name),
    element("thead", {}, head),
    element("tbody", {}, ...body),
  );
  return element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": name }, node);
}

// A table below a chart, folded.
export function folded(name, columns, rows, open = false) {
  const inner = table(name, columns, rows);
  return element("details", { class: "data", open }, element("summary", {}, "Table"), inner);
}

function csvCell(text) {
  const safe = /^[=+\-@\t\r]/.test(text) && Number.isNaN(Number(text)) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

// RFC 4180, every digit.
export function csvOf(tableNode) {
  const rows = [...tableNode.rows].map((row) =>
    [...row.cells].map((cell) => csvCell(cell.dataset.v ?? cell.dataset.id ?? cell.textContent)).join(","),
  );
  return rows.join("\r\n") + "\r\n";
}

function save(name, text) {
  const link = element("a", { download: name, href: URL.createObjectURL(new Blob([text], { type: "text/csv" })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// A button for each table that has none yet.
export function addCsvButtons(root) {
  for (const node of root.querySelectorAll("table:not([data-csv])")) {
    node.dataset.csv = "";
    const name = node.caption?.textContent ?? "table";
    const file = `${name.replaceAll(/[^\w.+-]+/g, "_")}.csv`;
    const button = element("button", { type: "button", class: "csv", onclick: () => save(file, csvOf(node)) }, "CSV");
    button.setAttribute("aria-label", `Save ${name} as CSV`);
    node.caption?.append(" ", button);
  }
}

export async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = element("textarea", {}, text); // files opened from a mail have no clipboard
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  const before = button.textContent;
  button.textContent = "Copied";
  setTimeout(() => (button.textContent = before), 1200);
}

export function select(label, options, value, onchange) {
  const list = element(
    "select",
    { onchange: (event) => onchange(Number(event.target.value)) },
    ...options.map(({ text, disabled, title }, i) =>
      element("option", { value: i, selected: i === value, disabled, title }, text),
    ),
  );
  return element("label", { class: "pick" }, element("span", {}, label), list);
}
