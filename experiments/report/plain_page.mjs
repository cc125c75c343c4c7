// A page of text and tables that needs nothing else. `more`: CSS of its own.
import { escape_html } from './src/format.mjs';

export const plain_page = (
  title,
  body,
  { width = '60rem', more = '' } = {},
) => `<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escape_html(title)}</title>
<style>
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: ${width}; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: .3rem .8rem .3rem 0; border-bottom: 1px solid #8886;
         vertical-align: top; }
${more}</style></head><body><main>
${body}
</main></body></html>
`;
