// The page of ./tress ask: what the tables of one scene say, and nothing where one is not there.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';

const program = fileURLToPath(new URL('../../experiments/report/answers.mjs', import.meta.url));

function page(tables) {
  const folder = mkdtempSync(join(tmpdir(), 'tress-answers-'));
  for (const [name, text] of Object.entries(tables)) writeFileSync(join(folder, name), text);
  execFileSync(process.execPath, [program, folder]);
  return readFileSync(join(folder, 'answers.html'), 'utf8');
}

test('steps come longest first; a capped one is a bound; a reason stands for none', () => {
  const html = page({
    'stability_limit.csv': `scene,integrator,jacobian,dt_max_s,limited_by,realtime_factor,reason
mine,rk4,,,energy,,no <step>
mine,bdf2,exact,0.002,energy,4,
mine,backward_euler,exact,0.1,cap,100,
`,
  });
  assert.match(html, /<h1>mine<\/h1>/);
  const places = ['≥ 100 ms', '>2 ms<', 'no &lt;step&gt;'].map((text) => html.indexOf(text));
  assert.ok(places.every((place) => place > 0), String(places));
  assert.deepEqual(places, [...places].sort((a, b) => a - b));
  assert.match(html, /250 ms/); // a simulated second of bdf2
});

test('a row that ended early is inconclusive, not without a stable step', () => {
  const html = page({
    'stability_limit.csv': `study,scene,integrator,jacobian,dt_max_s,limited_by,realtime_factor,tolerance_loosest,tolerance_tightest,steps_usual,status,reason
file,mine,bdf2,exact,,,,,,,inconclusive,too little work
file,mine,rk4,exact,,,,,,,unstable,too fast
tolerance,mine,tr_bdf2,exact,,,,,,,timeout,killed
`,
  });
  assert.match(html, /<td>bdf2, jacobian exact<\/td><td>inconclusive<\/td><td>too little work/);
  assert.match(html, /<td>rk4, jacobian exact<\/td><td>none<\/td><td>too fast/);
  assert.match(html, /<td>tr_bdf2, jacobian exact<\/td><td>inconclusive<\/td><td>killed/);
});

test('what is stable by tolerance stands in a table of its own', () => {
  const html = page({
    'stability_limit.csv': `study,scene,integrator,jacobian,dt_max_s,limited_by,realtime_factor,tolerance_loosest,tolerance_tightest,steps_usual,reason
file,mine,bdf2,exact,0.002,energy,4,,,,
tolerance,mine,tr_bdf2,exact,,cap,,0.1,0.0001,321,
tolerance,mine,esdirk43,exact,,energy,,,,,no <tolerance>
`,
  });
  assert.match(html, /<td>tr_bdf2, jacobian exact<\/td><td>1e-1<\/td><td>1e-4<\/td><td>321<\/td>/);
  assert.match(html, /<td>esdirk43, jacobian exact<\/td><td>none<\/td><td>no &lt;tolerance&gt;<\/td>/);
  assert.equal(html.match(/tr_bdf2/g).length, 1);
});

test('outcomes stand beside each other by step, the shortest first; what failed says why', () => {
  const html = page({
    'hard_cases.csv': `case,model,variant,integrator,dt_s,outcome,passed,why
mine,der,jacobian=exact,rk4,0.03,unstable,false,too <fast> at t = 0.1 s
mine,der,jacobian=exact,rk4,0.003,stable,true,nothing to compare with
mine,der,jacobian=elastic,rk4,0.03,unstable,false,unstable: a piece is off
mine,xpbd_cosserat,,bdf2,0.03,stable,true,nothing to compare with
`,
  });
  assert.match(html, /<th>step 3 ms<\/th><th>step 30 ms<\/th>/);
  assert.match(html, /<td>der, jacobian=exact, rk4<\/td><td>stable<\/td><td>unstable: too &lt;fast&gt; at t = 0.1 s<\/td>/);
  assert.match(html, /<td>unstable: a piece is off<\/td>/);
  assert.match(html, /<td>xpbd_cosserat, bdf2<\/td><td><\/td><td>stable<\/td>/);
});

test('tolerances stand behind the steps, the tightest first', () => {
  const html = page({
    'hard_cases.csv': `case,model,variant,integrator,dt_s,position_tol_rel,outcome,passed,why
mine,der,,tr_bdf2,0.03,1e-2,stable,true,
mine,der,,tr_bdf2,0.03,1e-3,unstable,false,fell
mine,der,,tr_bdf2,0.03,,stable,true,
`,
  });
  assert.match(html, /<th>step 30 ms<\/th><th>tolerance 1e-3<\/th><th>tolerance 1e-2<\/th>/);
  assert.match(html, /<td>der, tr_bdf2<\/td><td>stable<\/td><td>unstable: fell<\/td><td>stable<\/td>/);
});

test('effects and advice are shown in words', () => {
  const html = page({
    'effect_audit.csv': `scene,effect,error_without_rel,cost_share,verdict,reason
mine,none,,,,
mine,wind,0.25,0.5,keep,
`,
    'cost_of_accuracy.csv': `kind,model,modes,jacobian,options,elements,integrator,dt_s,error_rel,ms_per_frame,reason
winner,der,,exact,,8,bdf2,0.001,0.005,2,
front,der,,exact,,9,bdf2,0.001,0.004,3,
`,
  });
  assert.match(html, /<td>wind<\/td><td>25 %<\/td><td>50 %<\/td><td>keep<\/td>/);
  assert.match(html, /<td>take<\/td><td>der, jacobian exact, 8 elements, bdf2, dt 1 ms<\/td><td>0.5 %<\/td>/);
  assert.match(html, /9 elements/);
});

const advice = (rows) => page({
  'cost_of_accuracy.csv': `kind,status,model,elements,integrator,dt_s,target_error_rel,error_rel,ms_per_frame,horizon_s,duration_s,search,reason
${rows}`,
});

test('a run that is no answer is not taken; one for a part of the scene names the part', () => {
  const failed = advice(`winner,no_answer,der,8,bdf2,0.001,0.01,0.03,2,2,2,cut: 3 of 9,no run
`);
  assert.match(failed, /<td>no run within 1 % so far; best so far<\/td><td>der, 8 elements/);
  assert.doesNotMatch(failed, /<td>take/);
  assert.match(advice(`winner,no_answer,der,8,bdf2,0.001,0.01,0.03,2,2,2,whole,no run
`), /no run within 1 % with any method tried; best so far/);
  assert.match(advice(`winner,no_answer,der,8,bdf2,0.001,0.01,0.001,2,2,2,whole,no run
`), /no run within 1 % with neighbours that hold with any method tried; best so far/);
  const part = advice(`winner,valid_in_part,der,8,bdf2,0.001,0.01,0.003,2,0.5,2,whole,part only
`);
  assert.match(part, /<td>take<\/td>.*<td>the first 500 ms of 2 s<\/td>/);
  assert.match(advice(`winner,file_differs,der,8,bdf2,0.001,0.01,0.003,2,2,2,whole,differs
`), /<td>no answer: differs<\/td>/);
  assert.match(advice(`,no_reference,,,,,,,,,,,models part
`), /<td>no answer: models part<\/td>/);
});

test('a table that is not there leaves a gap, never no page', () => {
  assert.match(page({}), /No row/);
});
