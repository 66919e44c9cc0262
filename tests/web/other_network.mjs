// other_network.mjs MODEL OUTPUT: the model with every weight and bias of its network times 0.75, all else as it is.
import { readFileSync, writeFileSync } from 'node:fs';

const [input, output] = process.argv.slice(2);
const bytes = readFileSync(input);
const size = Number(bytes.readBigUInt64LE(0)); // of the header, JSON; then the numbers
const header = JSON.parse(bytes.subarray(8, 8 + size).toString());
for (const [name, { dtype, data_offsets: [begin, end] = [0, 0] }] of Object.entries(header)) {
  if (!name.startsWith('net.')) continue;
  if (dtype !== 'F32') throw new Error(`${name} is ${dtype}, expected F32`);
  for (let at = 8 + size + begin; at < 8 + size + end; at += 4) bytes.writeFloatLE(0.75 * bytes.readFloatLE(at), at);
}
writeFileSync(output, bytes);
