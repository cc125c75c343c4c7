// Words that state an amount: like a number they need a query, or a reason to stand.
const count =
  'two|three|four|five|six|seven|eight|nine|ten|eleven|twelve|thirteen|fourteen|fifteen|sixteen|seventeen|eighteen|nineteen|twenty|thirty|forty|fifty|sixty|hundreds?|thousands?|millions?|billions?|dozens?';
const part = 'third|quarter|fifth|sixth|eighth|tenth|hundredth|thousandth|millionth|hundred-thousandth';
const population = 'of|cases|runs|rows|hairs|strands|models|methods|integrators|scenes|steps|winners|tests|pairs|answers|problems';

export const number_words = new RegExp(
  [
    `\\b(?:${count})\\b`,
    `\\b(?:an?|one|two|three) (?:${part})s?\\b|\\bquarters\\b|\\bthirds\\b`,
    '\\bhal(?:f|ves)\\b',
    '\\btwice\\b|\\bdoubl(?:e|es|ed)\\b|\\btripl(?:e|es|ed)\\b|\\bmany times\\b',
    // An amount that somebody estimated; "about the axis" is none.
    `\\b(?:about|some|roughly|approximately|nearly|almost)\\s+(?=\\d|\\{\\{|(?:${count}|an? (?:${part}|hundred|thousand|million)|half|twice|all|none|every)\\b)`,
    `(?<!\\bat )(?<!\\bthe )\\b(?:most|few|hardly any|the majority|several) (?:of the |of these )?(?:${population})\\b`,
    '\\bmostly\\b|\\bmajority\\b|\\borders? of magnitude\\b',
  ].join('|'),
  'gi',
);
