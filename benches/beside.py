#!/usr/bin/env python3
"""Runs `flockworks bench` beside another program in one session and prints the ratios of their speeds.

    benches/beside.py FLOCKWORKS LIMIT [--agents N] [--rounds K]

FLOCKWORKS is the release binary; LIMIT is a program with the command line of the limit prototype (workload w1 or w2,
-n agents, -s steps, -w warm-up, -t threads, -k kernel, -x cells, -r repeats) that prints `upd/s=...` for each repeat. The two take
turns, round by round, so that a machine whose speed drifts treats both alike; medians are compared.
"""
import argparse
import json
import re
import statistics
import subprocess


def ours(binary, workload, agents, threads, precision, steps):
    command = [binary, "bench", workload, "--agents", str(agents), "--threads", str(threads), "--precision", precision]
    command += ["--steps", str(steps), "--repeats", "3", "--json"]
    rows = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return rows[0]["agent_updates_per_s"]


def theirs(binary, workload, agents, threads, steps):
    kernel, cells = ("blk", "4") if workload == "W1" else ("blkp", "2")
    command = [binary, workload.lower(), "-n", str(agents), "-s", str(steps), "-w", "10", "-k", kernel, "-x", cells]
    command += ["-r", "4", "-t", str(threads)]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    speeds = [float(found) for found in re.findall(r"upd/s=([\d.e+]+)", text)]
    return statistics.median(speeds[1:])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("flockworks")
    parser.add_argument("limit")
    parser.add_argument("--agents", type=int, default=100_000)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    print("| workload | threads | ours f32 M/s | ours f64 M/s | limit f32 M/s | f32 / limit | f64 / limit | gain ours | gain limit |")
    print("|---|---|---|---|---|---|---|---|---|")
    for workload, steps in (("W1", 40), ("W2", 13)):
        single = None
        for threads in (1, 2):
            samples = {"f32": [], "f64": [], "limit": []}
            for _ in range(arguments.rounds):
                for precision in ("f32", "f64"):
                    speed = ours(arguments.flockworks, workload, arguments.agents, threads, precision, steps)
                    samples[precision].append(speed)
                samples["limit"].append(theirs(arguments.limit, workload, arguments.agents, threads, steps))
            middle = {name: statistics.median(values) for name, values in samples.items()}
            single = single or middle
            cells = [workload, threads] + [f"{middle[name] / 1e6:.2f}" for name in ("f32", "f64", "limit")]
            cells += [f"{middle[name] / middle['limit']:.2f}" for name in ("f32", "f64")]
            cells += [f"{middle[name] / single[name]:.2f}" for name in ("f32", "limit")]
            print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


if __name__ == "__main__":
    main()
