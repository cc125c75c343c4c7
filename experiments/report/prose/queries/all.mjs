// Queries by page: functions of the tables (rows as objects, by name) and the root of the
// repository, each of which returns the Markdown that stands in for its slot.
import * as catalogue from './catalogue.mjs';
import * as claims from './claims.mjs';
import * as cluster from './cluster.mjs';
import * as columns from './columns.mjs';
import * as compare from './compare.mjs';
import * as cost from './cost.mjs';
import * as damping from './damping.mjs';
import * as divided_heads from './divided_heads.mjs';
import * as drift from './drift.mjs';
import * as effects from './effects.mjs';
import * as equal from './equal.mjs';
import * as family from './family.mjs';
import * as findings from './findings.mjs';
import * as flight from './flight.mjs';
import * as friction from './friction.mjs';
import * as hard from './hard.mjs';
import * as head_accuracy from './head_accuracy.mjs';
import * as heads from './heads.mjs';
import * as machine from './machine.mjs';
import * as matrices from './matrices.mjs';
import * as newest from './newest.mjs';
import * as peers from './peers.mjs';
import * as player from './player.mjs';
import * as python from './python.mjs';
import * as references from './references.mjs';
import * as regrading from './regrading.mjs';
import * as scaling from './scaling.mjs';
import * as stability from './stability.mjs';
import * as swing from './swing.mjs';
import * as validation from './validation.mjs';

export const queries = {
  catalogue,
  claims,
  cluster,
  columns,
  compare,
  cost,
  damping,
  divided_heads,
  drift,
  effects,
  equal,
  family,
  findings,
  flight,
  friction,
  hard,
  head_accuracy,
  heads,
  machine,
  matrices,
  newest,
  peers,
  player,
  python,
  references,
  regrading,
  scaling,
  stability,
  swing,
  validation,
};
