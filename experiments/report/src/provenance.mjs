// Of which programs are the tables that stand together on the page?
const code_of = ({ manifest }) => {
  const { commit, dirty, changes } = manifest?.git ?? {};
  if (typeof commit !== 'string') return undefined;
  return commit.slice(0, 7) + (dirty ? ` with changes${changes ? ` ${changes}` : ''}` : '');
};

/// [['0123456', ['scaling', 'heads']], ...] of `tables` as load_results returns them.
export function commits_of(tables) {
  const all = new Map();
  for (const [name, table] of Object.entries(tables)) {
    const code = code_of(table) ?? 'unknown';
    all.set(code, [...(all.get(code) ?? []), name]);
  }
  return [...all].sort(([, a], [, b]) => b.length - a.length);
}

/// One sentence for tables of several commits; empty where all are of one.
export function mixed_commits(tables) {
  const commits = commits_of(tables);
  if (commits.length < 2) return '';
  const each = commits.map(([code, names]) => `${code} (${names.join(', ')})`);
  return (
    `The tables are of ${commits.length} commits, not of one: ${each.join('; ')}. ` +
    'Differences between tables of different commits may be differences of the programs.'
  );
}
