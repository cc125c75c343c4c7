// Tables of several commits do not stand side by side without a word.
import assert from 'node:assert/strict';
import test from 'node:test';
import { commits_of, mixed_commits } from '../../experiments/report/src/provenance.mjs';

const of = (commit, dirty = false, changes = '') => ({
  manifest: { git: { commit, dirty, changes } },
});

test('tables of one commit need no word', () => {
  assert.equal(mixed_commits({ heads: of('0123456789'), scaling: of('0123456789') }), '');
  assert.equal(mixed_commits({}), '');
});

test('tables of several commits are named, each with its own', () => {
  const tables = {
    heads: of('0123456789'),
    other_simulators: of('abcdef0123'),
    scaling: of('0123456789'),
    swing: {},
  };
  assert.deepEqual(commits_of(tables), [
    ['0123456', ['heads', 'scaling']],
    ['abcdef0', ['other_simulators']],
    ['unknown', ['swing']],
  ]);
  assert.match(
    mixed_commits(tables),
    /^The tables are of 3 commits, not of one: 0123456 \(heads, scaling\); abcdef0 \(other_simulators\); unknown \(swing\)\. /,
  );
});

test('two states of one commit are two', () => {
  const tables = { a: of('0123456789', true, 'aa'), b: of('0123456789', true, 'bb') };
  assert.match(mixed_commits(tables), /0123456 with changes aa \(a\); 0123456 with changes bb/);
});
