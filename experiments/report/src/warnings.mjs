// What could not be used, each said once.
export class Warnings {
  // {text, table}: `table` is the name of the table that is left out, if one is. The text is
  // for the page, which names files by where they lie in `directory`.
  list = [];

  constructor(directory, say) {
    this.prefix = directory.endsWith('/') ? directory : `${directory}/`;
    this.say = say;
  }

  // On one line, whatever a file's name or a value holds.
  add(text, table) {
    const line = text.replace(/\p{Cc}+/gu, ' ');
    const shown = line.replaceAll(this.prefix, '');
    if (this.list.some((other) => other.text === shown)) return;
    this.list.push({ text: shown, table });
    this.say(`report: warning: ${line}`);
  }

  of(table) {
    return this.list.find((warning) => warning.table === table)?.text;
  }

  // The values of a file are such that `what` threw.
  failed(file, what, error) {
    this.add(
      `${file}: ${what} cannot be made of its values (${error.message}); run the ` +
        'experiment again or remove the file',
    );
  }

  // `make()`, or `otherwise` and a warning when that throws.
  guard(file, what, make, otherwise) {
    try {
      return make();
    } catch (error) {
      this.failed(file, what, error);
      return otherwise;
    }
  }
}
