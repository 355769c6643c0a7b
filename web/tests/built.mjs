// The program or an example of it, built as the Rust tests are: with all crates at once, so that nothing is compiled twice.

import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../..", import.meta.url));

/** Builds and gives the path of `flockworks` or `sample_page`. */
export function built(name) {
  const words = ["build", "--quiet", "--workspace", "--bin", "flockworks", "--example", "sample_page", "--message-format=json"];
  const lines = execFileSync(process.env.CARGO ?? "cargo", words, { cwd: root, maxBuffer: 1 << 26, stdio: ["ignore", "pipe", "inherit"] });
  const messages = lines.toString().split("\n").filter((line) => line.startsWith("{")).map((line) => JSON.parse(line));
  return messages.find((message) => message.executable && message.target.name === name).executable;
}
