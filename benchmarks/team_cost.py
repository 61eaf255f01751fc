"""What a pass costs by MPI, and where each algorithm stops scaling.

    PYTHONPATH=build/python python3 benchmarks/team_cost.py build/etendue [--ranks 1,2,4,8] [--renderer PathTracer ...] [--save F] [--load F]

Measures, for each algorithm on the Cornell box: what is sent in a pass, and the processor time of its items (divided among the processes), of what
each process does for itself (trees of photons, guides, sums in order), and of sending and receiving. These are counted, so an oversubscribed
machine will do, and one with other work, which makes them some percent larger.

From them follows a model of a pass on N machines of C cores:

    T(N) = max(items / (N C), (results + tiles) / bandwidth, messages × time of each, sums) + own / 4 + calls × 2 (delay + look)

`results` is what all processes receive (photons, chains, training samples: the same amount whatever N), `tiles` what the leader receives, and
adds to the picture, which takes it `sums`. All of these happen while items are computed, so only the largest counts. `own` is not divided among the
processes; trees are built by all threads of each and results are put in order by one, which is assumed to be four times as fast as one
thread. `look` is how long a message may wait until a thread looks for it (src/render/team/post.cpp). Left out are contention within the
network, and that the last items end at different times.

A pass of a large picture is one sample for each pixel, so one is measured, and all of it is proportional to the number of pixels.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

SCENE = pathlib.Path(__file__).resolve().parents[1] / "scenes" / "cornell_box.etd"
RENDERERS = {  # samples: some have passes of several
    "PathTracer": 1, "BidirectionalPathTracer": 1, "GuidedPathTracer": 16, "AdaptiveSampling": 16, "PhotonMapper": 1,
    "ProgressivePhotonMapper": 1, "VertexConnectionMerging": 1, "PrimarySampleMetropolis": 1, "MultiplexedMetropolis": 1,
}
CORES, OWN_THREADS = 32, 4  # of a machine; see above
DELAY, LOOK, MESSAGE = 10e-6, 0.5e-3, 5e-6  # of the network, until a thread looks, to send or receive a small message [s]
DEARER = (1, 20)  # how many times the work of an item is that of the Cornell box, which is among the cheapest scenes
MEASURED, SHOWN = (256, 256), (1920, 1080)
MACHINES = [16, 64, 256, 1024]
NETWORKS = {"10 Gbit/s": 10e9 / 8, "100 Gbit/s": 100e9 / 8}  # [bytes/s]


def measured(program, renderer, samples, ranks, folder):
    """Of a pass, summed over all processes."""
    command = ["mpirun", "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", str(ranks), program, "render", str(SCENE)]
    command += ["--size", f"{MEASURED[0]}x{MEASURED[1]}", "--set", f"renderer={renderer} {{}}", "--samples", str(samples)]
    command += ["--threads", "1", "--progress", "json", "-o", f"{folder}/a.npy"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{renderer}: {done.stderr}")
    report = json.loads(done.stdout.splitlines()[-1])
    passes = -(-samples // min(report["samples_per_pass"], samples))
    each = report["processes"]
    own = [p["processor_seconds"] - p["item_seconds"] - p["message_seconds"] for p in each]
    leader, followers = each[0], each[1:]
    return {
        "passes": passes,
        "leader_sends": leader["sent_bytes"] / passes,
        "followers_send": sum(p["sent_bytes"] for p in followers) / passes,
        "leader_share": leader["item_seconds"] / sum(p["item_seconds"] for p in each),
        "messages": sum(p["sent_messages"] for p in each) / passes,
        "items": sum(p["item_seconds"] for p in each) / passes,
        "calls": leader["calls"] / passes,
        "own": sum(own[1:]) / len(own[1:]) / passes,
        "sums": max(own[0] - sum(own[1:]) / len(own[1:]), 0) / passes,
        "post": sum(p["message_seconds"] for p in each) / passes,
    }


def parts(of):
    """What all receive, and what the leader alone receives: the leader sends the results of its items to N - 1 others, each of the others
    those of its items to N - 1 and its tiles to the leader. The time of items tells who has computed how many."""
    found = []
    for n, m in of.items():
        results = m["leader_sends"] / ((n - 1) * m["leader_share"])
        tiles = (m["followers_send"] - results * (n - 1) * (1 - m["leader_share"])) / (1 - m["leader_share"])
        found.append((results, max(tiles, 0.0)))
    return tuple(sum(values) / len(found) for values in zip(*found))


def modelled(cost, machines, bandwidth, dearer):
    """Seconds of a pass, and what takes them."""
    scale = SHOWN[0] * SHOWN[1] / (MEASURED[0] * MEASURED[1])
    larger = {"computing": cost["items"] * dearer * scale / (machines * CORES)}
    if machines > 1:
        larger["the network"] = (cost["results"] + cost["tiles"]) * scale / bandwidth
        larger["messages"] = cost["messages"] * scale * MESSAGE
        larger["the leader's sums"] = cost["sums"] * scale
    limit = max(larger, key=larger.get)
    own = cost["own"] * scale / OWN_THREADS
    rest = own + (cost["calls"] * 2 * (DELAY + LOOK) if machines > 1 else 0)
    if rest > larger[limit]:
        limit = "each for itself"
    return max(larger.values()) + rest, limit


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--ranks", default="1,2,4,8")
    parser.add_argument("--renderer", action="append", choices=RENDERERS)
    parser.add_argument("--save", help="write what was measured to this file")
    parser.add_argument("--load", help="measure only --renderer, and take the others from this file")
    arguments = parser.parse_args()
    ranks = sorted({int(n) for n in arguments.ranks.split(",")} - {1})
    costs = json.loads(pathlib.Path(arguments.load).read_text()) if arguments.load else {}
    with tempfile.TemporaryDirectory() as folder:
        for renderer in arguments.renderer or ([] if arguments.load else RENDERERS):
            of = {n: measured(arguments.program, renderer, RENDERERS[renderer], n, folder) for n in ranks}
            results, tiles = parts(of)
            least = of[ranks[0]]
            costs[renderer] = {key: min(m[key] for m in of.values()) for key in ("items", "own", "sums")} | {
                "results": results, "tiles": tiles, "messages": least["messages"], "calls": least["calls"],
                "sent": {str(n): m["leader_sends"] + m["followers_send"] for n, m in of.items()},
            }
            if arguments.save:
                pathlib.Path(arguments.save).write_text(json.dumps(costs, indent=1))
    print_measured(costs)
    for dearer in DEARER:
        for network, bandwidth in NETWORKS.items():
            print_modelled(costs, network, bandwidth, dearer)


def print_measured(costs):
    counts = list(next(iter(costs.values()))["sent"])
    print(f"Of a pass, {MEASURED[0]} × {MEASURED[1]} pixels:\n")
    print("| algorithm | items [ms] | each for itself [ms] | the leader's sums [ms] | calls | results to all [kB] | tiles to the leader [kB] | "
          + " | ".join(f"sent by all of {n} [kB]" for n in counts) + " |")
    print("|---" * (7 + len(counts)) + "|")
    for renderer, c in costs.items():
        cells = [f"{c['items'] * 1e3:.0f}", f"{c['own'] * 1e3:.1f}", f"{c['sums'] * 1e3:.1f}", f"{c['calls']:.0f}", f"{c['results'] / 1e3:.0f}",
                 f"{c['tiles'] / 1e3:.0f}", *(f"{c['sent'][n] / 1e3:.0f}" for n in counts)]
        print(f"| `{renderer}` | " + " | ".join(cells) + " |")


def print_modelled(costs, network, bandwidth, dearer):
    print(f"\n{network}, items that take {dearer} times as long as in the Cornell box:\n")
    print("| algorithm | " + " | ".join(f"{n} machines" for n in MACHINES) + " |")
    print("|---" * (1 + len(MACHINES)) + "|")
    for renderer, cost in costs.items():
        one = modelled(cost, 1, bandwidth, dearer)[0]
        cells = []
        for n in MACHINES:
            seconds, limit = modelled(cost, n, bandwidth, dearer)
            cells.append(f"{one / seconds:.1f}, {limit}")
        print(f"| `{renderer}` | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
