// Starts the page's program, which the page carries compressed; its policy knows the
// program by its hash.
import { unpacked } from './unpack.mjs';

const program = document.createElement('script');
program.textContent = new TextDecoder().decode(
  unpacked(document.getElementById('packed-program').textContent),
);
document.body.append(program);
