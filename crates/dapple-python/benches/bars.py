"""Measures the promises of the package about time and memory: `python benches/bars.py [NAME…] [--dapple COMMAND]`.

    fields       F2 - F1 and PUPs at 1024 x 1024, ns per pixel, relative to Rust (`--rust NS,NS`, from `cargo xtask bench`)
    shards       8192 x 8192 heights in shards of 1024 into Zarr: processor time relative to `dapple bake`
    workers      two workers relative to one, in wall-clock time
    memory       the largest memory of a worker
    kills        runs whose workers are killed at random moments, and whole clusters (`--runs N,N`)
    chunks       what a chunk costs beyond its pixels; `--many` with 100,000 shards
    import       the time of the import relative to NumPy, and the size of the wheel

Times are medians of sequential runs. Run it on an idle machine.
"""

from __future__ import annotations

import argparse
import glob
import hashlib
import os
import random
import resource
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

import dapple_textures as dp

RECIPE = "rock"


def median(run, times=7):
    return statistics.median(run() for _ in range(times))


def fields(options):
    cells = dp.worley(seed=7, value="f2_minus_f1")
    points = dp.poisson_disk(dp.Domain(1), count=700, seed=1)
    land = dp.pups(points, np.random.default_rng(1).random(len(points)))
    out = np.empty((1024, 1024), np.float32)
    for name, field, extent, rust in [
        ("F2 - F1, 64 pixels per cell", cells, 16, options.rust[0]),
        ("PUPs, 700 points", land, 1, options.rust[1]),
    ]:

        def run(field=field, extent=extent):
            started = time.perf_counter()
            field.render(1024, extent=extent, out=out)
            return (time.perf_counter() - started) * 1e9 / 1024**2

        beside = "" if rust is None else f", {ratio(median(run, 31), rust)} of Rust's {rust}"
        print(f"{name}: {median(run, 31):.2f} ns/pixel{beside}")


def ratio(value, reference):
    return f"{value / reference:.2f} times"


def cpu(pid="self"):
    """The processor time of a process, in seconds."""
    parts = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(parts[11]) + int(parts[12])) / os.sysconf("SC_CLK_TCK")


def peak(pid):
    """The largest memory that a process had, in MiB."""
    status = Path(f"/proc/{pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def cluster(workers):
    from dask import config
    from distributed import LocalCluster

    # A local cluster closes a worker that is away when this time after an earlier death is over.
    config.set({"distributed.deploy.lost-worker-timeout": "1h"})
    return LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None)


def bake(workers, side, shard, planes=("height",), what=None):
    """Processor time of workers and of the rest, wall time, and memory of the workers."""
    from distributed import Client

    from dapple_textures import jobs
    from dapple_textures.dask import bake_job

    with tempfile.TemporaryDirectory() as folder, cluster(workers) as them, Client(them) as client:
        pids = list(client.run(os.getpid).values())
        # The first shard makes workers import their modules, which is not measured.
        bake_job(jobs.create(dp.constant(0), (2 * workers, 64), ["value"], f"{folder}/first.zarr", shard=(1, 64)), client=client)
        idle = [peak(pid) for pid in pids]
        before, mine, started = sum(map(cpu, pids)), cpu(), time.perf_counter()
        bake_job(jobs.create(what or dp.Recipe.builtin(RECIPE), side, planes, f"{folder}/a.zarr", shard=shard), client=client)
        wall = time.perf_counter() - started
        return {
            "workers": sum(map(cpu, pids)) - before,
            "scheduler": cpu() - mine,
            "wall": wall,
            "idle": max(idle),
            "peak": max(map(peak, pids)),
        }


def shards(options):
    from dask import config

    with config.set({"distributed.worker.memory.target": False}):
        ours = [bake(2, 8192, 1024) for _ in range(3)]
    total = statistics.median(run["workers"] + run["scheduler"] for run in ours)
    parts = ", ".join(f"{run['workers']:.1f} + {run['scheduler']:.1f}" for run in ours)
    if options.dapple is None:
        return print(f"8192 x 8192 in 64 shards: {parts} s of processor time")

    def command():
        with tempfile.TemporaryDirectory() as folder:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            arguments = ["bake", RECIPE, "--maps", "height", "--size", "8192", "--banded", "-o", f"{folder}/a.exr", "-q"]
            subprocess.run([options.dapple, *arguments], check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    theirs = median(command, 3)
    print(f"8192 x 8192 in 64 shards: {parts} s of processor time, the command {theirs:.1f} s: {ratio(total, theirs)}")


def workers(_options):
    one, two = ([] for _ in range(2))
    for _ in range(3):
        one.append(bake(1, 8192, 1024)["wall"])
        two.append(bake(2, 8192, 1024)["wall"])
    print(f"one worker {statistics.median(one):.2f} s, two {statistics.median(two):.2f} s: {ratio(statistics.median(one), statistics.median(two))} as fast")


def memory(_options):
    for shard, planes in [(1024, ("height",)), (2048, ("height",)), (2048, ("normal",))]:
        run = bake(1, 8192, shard, planes)
        size = shard**2 * 4 * (3 if planes == ("normal",) else 1) / 2**20
        print(f"shards of {shard}, {planes[0]}: {run['idle']:.0f} MiB before, peak {run['peak']:.0f}, bar {130 + 4 * size:.0f}")


def digest(place):
    import zarr

    group = zarr.open_group(place, mode="r")
    hashes = [hashlib.sha256(np.ascontiguousarray(group[name][:])).hexdigest() for name in sorted(group.keys())]
    return " ".join(hashes)


def kills(options):
    """Workers are killed with SIGKILL at random moments; then whole clusters, which are started again."""
    from distributed import Client, Status

    from dapple_textures import jobs
    from dapple_textures.dask import bake_job

    recipe, shape, planes = dp.Recipe.builtin(RECIPE), (1024, 1024), ["height", "normal"]
    whole = recipe.plan().bake(shape, planes)
    expected = " ".join(hashlib.sha256(whole[plane]).hexdigest() for plane in planes)
    chance = random.Random(1)
    deaths = 0
    runs, clusters = options.runs
    with cluster(3) as them, Client(them) as client, tempfile.TemporaryDirectory() as folder:
        for number in range(runs):
            done = threading.Event()

            def kill():
                nonlocal deaths
                while not done.wait(chance.uniform(0.05, 0.6)):
                    # A nanny gives up a worker that dies before it has begun.
                    ready = [nanny.process for nanny in them.workers.values() if nanny.status == Status.running]
                    pids = [process.pid for process in ready if process and process.status == Status.running]
                    if pids:
                        os.kill(chance.choice(pids), signal.SIGKILL)
                        deaths += 1
                        done.wait(chance.uniform(1, 3))

            killer = threading.Thread(target=kill)
            killer.start()
            place = f"{folder}/{number}.zarr"
            client.wait_for_workers(1, timeout=60)
            bake_job(jobs.create(recipe, shape, planes, place, shard=64), client=client)
            done.set()
            killer.join()
            assert digest(place) == expected, f"run {number} has other bits"
            shutil.rmtree(place)
            print(f"run {number}: {deaths} killed so far", flush=True)
    print(f"{runs} runs with {deaths} killed workers: all have the bits of the whole")
    for number in range(clusters):
        with tempfile.TemporaryDirectory() as folder:
            place = f"{folder}/a.zarr"
            resumed = 0
            while True:
                program = (
                    "import sys; from distributed import Client, LocalCluster\n"
                    "import dapple_textures as dp; from dapple_textures import jobs; from dapple_textures.dask import bake_job\n"
                    "if __name__ == '__main__':\n"
                    "    c = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)\n"
                    f"    bake_job(jobs.create(dp.Recipe.builtin({RECIPE!r}), {shape}, {planes}, {place!r}, shard=64), client=Client(c))\n"
                )
                script = Path(folder) / "run.py"
                script.write_text(program)
                process = subprocess.Popen([sys.executable, script], start_new_session=True, stderr=subprocess.DEVNULL)
                deadline = time.monotonic() + 20
                # Killed when some more of the shards are there, three times.
                enough = 100 * (resumed + 1)
                while process.poll() is None and time.monotonic() < deadline:
                    if resumed < 3 and len(glob.glob(f"{place}/*/c/*/*")) > enough:
                        break
                    time.sleep(0.005)
                if process.poll() is None and resumed < 3:
                    os.killpg(process.pid, signal.SIGKILL)
                    resumed += 1
                process.wait()
                if not jobs.Job(place).missing():
                    break
            assert digest(place) == expected, f"cluster {number} has other bits"
            print(f"cluster {number}: killed {resumed} times, the bits of the whole")


def chunks(options):
    run = bake(2, 2048, 64, ("value",), dp.constant(0.5))
    count = 32 * 32
    print(f"{count} shards without work: {(run['workers'] + run['scheduler']) / count * 1e3:.1f} ms each ({run['workers'] / count * 1e3:.1f} workers, {run['scheduler'] / count * 1e3:.1f} the rest)")
    if options.many:
        before = peak("self")
        run = bake(2, (317, 317), 1, ("value",), dp.constant(0.5))
        print(f"{317**2} shards: {run['wall']:.0f} s, scheduler and client {before:.0f} MiB before and {peak('self'):.0f} MiB at most")


def import_(_options):
    program = "import time, numpy; t = time.perf_counter(); import dapple_textures; print((time.perf_counter() - t) * 1e3)"
    # As it is installed: compiled, not from its sources each time.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}

    def run():
        done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
        return float(done.stdout)

    run()
    print(f"import beside NumPy: {median(run, 15):.1f} ms")


def main():
    bars = {"fields": fields, "shards": shards, "workers": workers, "memory": memory, "kills": kills, "chunks": chunks, "import": import_}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", choices=[*bars, []], default=[])
    parser.add_argument("--dapple", help="the command, to be timed beside")
    parser.add_argument("--rust", type=lambda text: [float(part) for part in text.split(",")], default=[None, None])
    parser.add_argument("--runs", type=lambda text: [int(part) for part in text.split(",")], default=[10, 1])
    parser.add_argument("--many", action="store_true")
    options = parser.parse_args()
    for name in options.names or bars:
        bars[name](options)


if __name__ == "__main__":
    main()
