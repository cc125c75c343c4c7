export const is_object = (value) =>
  value !== null && typeof value === 'object' && !Array.isArray(value);

// Rows as objects, the form figures and findings work on; `glossary`: of every table what
// values of a column mean.
export const all_objects = (tables) => ({
  ...Object.fromEntries(
    Object.entries(tables).map(([name, table]) => [name, as_objects(table)]),
  ),
  glossary: Object.fromEntries(
    Object.entries(tables).map(([name, { glossary }]) => [name, glossary ?? {}]),
  ),
});

function as_objects({ columns, rows }) {
  return rows.map((row) => Object.fromEntries(columns.map((c, i) => [c.name, row[i]])));
}
