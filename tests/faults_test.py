"""What the command does when the system around it says no: nothing is lost, nothing is left behind, one clear line.

usage: faults_test.py IGSP [unittest arguments]
"""
import json
import os
import resource
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from cli_test import IGSP, CommandTest, read_ply, setUpModule  # noqa: F401, the last one makes the clouds

NOBODY = 65534

# In place of the system's: large files cannot be read from an offset on.
FAILING_READ = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
ssize_t read(int file, void* to, size_t count) {
  ssize_t (*original)(int, void*, size_t) = (ssize_t (*)(int, void*, size_t))dlsym(RTLD_NEXT, "read");
  struct stat status;
  int large = fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 150000;
  if (large && lseek(file, 0, SEEK_CUR) >= atol(getenv("FAIL_AFTER"))) return errno = EIO, -1;
  return original(file, to, count);
}
"""


class StandardStreams(CommandTest):
    """An answer that nobody gets is no success."""

    def commands(self):
        (self.folder / "T.txt").write_text("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
        (self.folder / "cases.csv").write_text(
            "name,source,target,truth,max_rotation_error_deg,max_translation_error_m\n"
            f"one,{self.source},{self.target},none,0,0\n")
        two = self.cloud("two.ply", [[0, 0, 0], [1, 1, 1]])
        return [["align", two, two], ["evaluate", "--transform", "T.txt", "--truth", "T.txt"], ["info", self.source],
                ["simulate", "object", "--points", "2000", "--out", "scans"], ["options"], ["options", "--json"],
                ["completion", "bash"], ["completion", "zsh"], ["completion", "fish"], ["manual"], ["--help"],
                ["--version"], ["align", "--help"], ["benchmark", "cases.csv", "--export", "exported"]]

    def test_a_full_device(self):
        for arguments in self.commands():
            with open("/dev/full", "w") as full:
                run = subprocess.run([IGSP, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True,
                                     cwd=self.folder)
            self.assertEqual(run.returncode, 3, arguments)
            # The system's reason is lost where it came before the last line.
            self.assertRegex(run.stderr, "^igsp: standard output: (No space left on device|cannot be written); the answer "
                                         "is lost\n$")

    def test_a_closed_one(self):
        for arguments in self.commands():
            run = subprocess.run(["sh", "-c", 'exec "$@" >&-', "sh", IGSP, *map(str, arguments)],
                                 stderr=subprocess.PIPE, text=True, cwd=self.folder)
            self.assertEqual(run.returncode, 3, arguments)
            self.assertEqual(run.stderr, "igsp: standard output: closed; the answer is lost\n")

    def test_no_file_takes_the_number_of_a_closed_one(self):
        # The report would be file 1, and the answer would go into it.
        run = subprocess.run(["sh", "-c", 'exec "$@" <&- >&- 2>&-', "sh", IGSP, "align", self.source, self.target,
                              "--report", "r.json", "--transform", "T.txt"], cwd=self.folder)
        self.assertEqual(run.returncode, 3)
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["verdict"], "registered")
        self.assertEqual(np.loadtxt(self.folder / "T.txt").shape, (4, 4))


class Signals(CommandTest):
    def large_run(self):
        """What writes for long: tens of megabytes of text."""
        rows = np.tile(read_ply(self.source)[0], (30, 1))
        large = self.cloud("large.ply", rows)
        return ["align", large, self.target, "--initial", self.truth, "-o"]

    def test_an_interrupt_while_writing_leaves_what_was_there(self):
        run = self.large_run()
        for output in ["a.xyz", "a.ply"]:  # coordinates only, and with all properties
            for number in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGXCPU]:
                before = self.file(output, "what was there")
                code, sent = self.under_terminal([*run, output], wait_for=b"write", then=number)
                self.assertEqual(code, 128 + number, sent)
                self.assertIn("igsp: interrupted", sent)
                self.assertEqual(before.read_text(), "what was there")
                before.unlink()
                self.assertEqual(os.listdir(self.folder), ["large.ply"])

    def test_killed_while_writing_leaves_nothing(self):
        try:
            os.close(os.open(self.folder, os.O_TMPFILE | os.O_WRONLY))
        except OSError:
            self.skipTest("this file system has no files without a name")
        code, _ = self.under_terminal([*self.large_run(), "a.xyz"], wait_for=b"write", then=signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        self.assertEqual(os.listdir(self.folder), ["large.ply"])

    def test_a_file_beyond_the_limit_of_its_size_is_an_error(self):
        run = subprocess.run([IGSP, *map(str, self.large_run()), "a.xyz"], capture_output=True, text=True,
                             cwd=self.folder,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20)))
        self.assertEqual((run.returncode, run.stderr), (3, "igsp: a.xyz: cannot write: File too large\n"))
        self.assertEqual(os.listdir(self.folder), ["large.ply"])

    def test_no_output_is_left_half_written(self):
        """Every file that a command writes, at a limit that the largest of them passes."""
        self.file("cases.csv", "name,source,target,truth,max_rotation_error_deg,max_translation_error_m\n"
                               f"one,{self.source},{self.target},none,0,0\n")
        pair = ["align", self.source, self.target]
        self.igsp(*pair, "--report", "run.json")
        for command, output in [([*pair, "-o"], "a.ply"), ([*pair, "-o"], "a.pcd"), ([*pair, "-o"], "a.csv"),
                                ([*pair, "--html"], "a.html"), ([*pair, "--report"], "a.json"),
                                ([*pair, "--transform"], "a.txt"), (["report", "run.json", "-o"], "b.html"),
                                (["simulate", "object", "--points", "3000", "--out"], "scans"),
                                (["benchmark", "cases.csv", "--export"], "exported")]:
            before = set(os.listdir(self.folder))
            run = subprocess.run([IGSP, *map(str, command), output], capture_output=True, text=True, cwd=self.folder,
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64)))
            self.assertEqual(run.returncode, 3, (command, output, run.stderr))
            self.assertRegex(run.stderr, "^igsp: .*: cannot write: File too large\n$")
            self.assertIn(output, run.stderr)
            made = set(os.listdir(self.folder)) - before
            self.assertLessEqual(made, {"scans", "exported"}, command)  # folders, which are made first
            for folder in made:
                for path in (self.folder / folder).rglob("*"):
                    self.assertTrue(path.is_dir(), path)

    def test_without_a_terminal_that_ends_it_nohup_runs_on(self):
        process = subprocess.Popen(["nohup", IGSP, *map(str, self.large_run()), "a.xyz"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL, cwd=self.folder)
        while not Path(f"/proc/{process.pid}/cmdline").read_bytes().startswith(os.fsencode(IGSP)):
            time.sleep(0.01)
        process.send_signal(signal.SIGHUP)
        self.assertEqual(process.wait(), 0)
        self.assertIn("a.xyz", os.listdir(self.folder))

    def test_a_file_that_may_not_be_written_is_not_replaced(self):
        path = self.file("kept.txt", "kept")
        path.chmod(0o444)
        self.folder.chmod(0o777)
        run = subprocess.run([IGSP, "align", "missing.ply", "missing.ply", "--transform", path], capture_output=True,
                             text=True, cwd=self.folder, user=NOBODY if os.geteuid() == 0 else None)
        self.assertEqual((run.returncode, run.stderr), (3, f"igsp: {path}: cannot write: Permission denied\n"))
        self.assertEqual(path.read_text(), "kept")


class SideInputs(CommandTest):
    """What readers of clouds check, all readers check: no pipe is waited for, no device read without an end."""

    def readers(self, path):
        self.file("T.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
        self.file("cases.csv", "name,source,target,truth,max_rotation_error_deg,max_translation_error_m\n"
                               "a,a.ply,a.ply,none,0,0\n")
        return [["align", path, self.target], ["align", self.source, path],
                ["align", self.source, self.target, "--initial", path],
                ["align", self.source, self.target, "--config", path], ["options", "--config", path],
                ["evaluate", "--transform", path, "--truth", "T.txt"],
                ["evaluate", "--transform", "T.txt", "--truth", path],
                ["evaluate", "--transform", "T.txt", "--truth", "T.txt", "--source", path],
                ["benchmark", path], ["benchmark", "cases.csv", "--compare", path], ["benchmark", "cases.csv", "--out", path],
                ["report", path, "-o", "r.html"], ["info", path]]

    def test_pipes_and_devices_are_refused_at_once(self):
        os.mkfifo(self.folder / "pipe.xyz")
        for path in ["pipe.xyz", "/dev/zero", "/dev/stdin"]:
            for arguments in self.readers(path):
                run = subprocess.run([IGSP, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder,
                                     stdin=subprocess.PIPE, timeout=60)
                self.assertEqual(run.returncode, 3, (arguments, run.stderr))
                self.assertIn("not a regular file", run.stderr)
                self.assertEqual(run.stderr.count("\n"), 1, run.stderr)

    def test_standard_input_is_no_cloud(self):
        self.refuses("align", "-", self.target, code=3, saying="-: standard input is not read")

    def test_a_folder_is_none(self):
        for arguments in self.readers(self.folder):
            self.refuses(*arguments, code=3, saying=[str(self.folder), "irectory"])

    def test_options_that_no_one_writes(self):
        depth = 200_000
        for text, saying in [("a." * depth + "a = 1\n", "200 letters"), ("[" + "a." * depth + "a]\n", "200 letters"),
                             ("a = " + "[" * depth + "\n", "igsp.toml"), ("x = 1 # much\n" * 100_000, "more than")]:
            self.file("igsp.toml", text)
            self.refuses("options", "--config", "igsp.toml", code=3, saying=saying)
        self.file("igsp.toml", "".join(f"[{'x.' * 90}x{i}]\n" for i in range(4000)))  # the deepest that the parser sees
        self.refuses("options", "--config", "igsp.toml", code=2, saying="unknown option")

    def test_lists_and_reports_that_no_one_writes(self):
        self.file("long.csv", "name," + "x" * 2_000_000)
        self.refuses("benchmark", "long.csv", code=3, saying="line 1: the line is longer than")
        for name in ["report.json", "list.csv"]:
            with open(self.folder / name, "wb") as file:
                file.truncate(10 << 30)  # sparse
        self.refuses("report", "report.json", "-o", "r.html", code=3, saying="report.json: holds more than")
        self.refuses("benchmark", "list.csv", code=3, saying="line 1: the line is longer than")


class Streaming(CommandTest):
    def test_the_order_of_a_streamed_cloud_chooses_nothing(self):
        rows = read_ply(self.source)[0]
        voxel_sizes, samples = [], []
        for seed in range(3):
            shuffled = self.cloud("shuffled.ply", np.random.default_rng(seed).permutation(rows))
            self.igsp("align", shuffled, self.target, "--max-points", "10000", "--report", "r.json")
            report = json.loads((self.folder / "r.json").read_text())
            self.assertTrue(report["source"]["streamed"])
            voxel_sizes.append(report["voxel_size"])
            samples.append(report["source"]["voxels"])
        np.testing.assert_allclose(voxel_sizes, voxel_sizes[0], rtol=1e-9)
        self.assertEqual(samples, [samples[0]] * 3)

    def test_points_without_number_at_one_place_do_not_push_out_the_others(self):
        rows = np.concatenate([np.zeros((200_000, 3)), read_ply(self.source)[0]])
        mixed = self.cloud("mixed.ply", rows)
        self.igsp("align", mixed, self.target, "--max-points", "10000")


class ChangingInputs(CommandTest):
    """A file that changes while it is read: an error that says so or the points that are there, never a crash."""

    def test_a_disk_that_fails_half_way(self):
        source = self.file("failing.c", FAILING_READ)
        library = self.folder / "failing.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
        np.savetxt(self.folder / "a.xyz", read_ply(self.source)[0])
        for name in [self.source, "a.xyz"]:
            for after in [0, 200_000]:
                run = subprocess.run([IGSP, "align", name, self.target, "-o", "b.xyz"], capture_output=True, text=True,
                                     cwd=self.folder, env={"LD_PRELOAD": str(library), "FAIL_AFTER": str(after)})
                self.assertEqual(run.returncode, 3, run.stderr)
                self.assertRegex(run.stderr, "^igsp: .*: byte offset \\d+: cannot read: Input/output error\n$")
        self.assertFalse((self.folder / "b.xyz").exists())

    def test_cut_or_grown_while_it_is_read(self):
        rows = np.tile(read_ply(self.source)[0], (20, 1))
        for kind in ["large.ply", "large.xyz"]:
            path = self.folder / kind
            if kind.endswith(".ply"):
                self.cloud(kind, rows)
            else:
                np.savetxt(path, rows, fmt="%.4f")
            content = path.read_bytes()
            for change in [content[: len(content) // 2], content + content[len(content) // 2 :], b""]:
                for delay in [0, 0.01, 0.03, 0.1]:
                    path.write_bytes(content)
                    process = subprocess.Popen([IGSP, "info", path], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                               text=True, cwd=self.folder)
                    time.sleep(delay)
                    with open(path, "r+b") as file:
                        file.truncate(min(len(change), len(content)))
                        file.seek(0, os.SEEK_END)
                        file.write(change[len(content) :])
                    _, said = process.communicate()
                    self.assertIn(process.returncode, [0, 3], said)
                    self.assertEqual(said.count("\n"), int(process.returncode == 3), said)


class Resources(CommandTest):
    def test_no_thread_can_be_started(self):
        if os.geteuid() != 0:
            self.skipTest("a limit that binds needs another user: only root can become one")
        program = "import os, resource, sys; resource.setrlimit(resource.RLIMIT_NPROC, (1, 1)); os.execv(sys.argv[1], sys.argv[1:])"
        for threads, code in [("2", 3), ("1", 0)]:
            with open(self.source) as source, open(self.target) as target:  # of folders that nobody may enter
                pair = [f"/proc/self/fd/{file.fileno()}" for file in (source, target)]
                run = subprocess.run(["/usr/bin/python3", "-c", program, IGSP, "align", *pair, "--threads", threads],
                                     capture_output=True, text=True, user=NOBODY, cwd="/",
                                     pass_fds=[source.fileno(), target.fileno()])
            if code == 3 and run.returncode == 0 and os.cpu_count() == 1:
                self.skipTest("one processor: no thread is started")
            self.assertEqual(run.returncode, code, run.stderr)
            if code:
                self.assertEqual(run.stderr, "igsp: no further thread can be started here; --threads 1 (and --jobs 1) "
                                             "needs none\n")

    def test_the_current_folder_is_gone(self):
        gone = self.folder / "gone"
        gone.mkdir()
        for arguments in [["align", "a.ply", "b.ply"], ["align", "a.ply", "b.ply", "-o", "c.ply"],
                          ["report", "run.json", "-o", "r.html"], ["benchmark", "cases.csv"],
                          ["benchmark", "cases.csv", "--export", "x"], ["simulate", "park", "--out", "x"]]:
            gone.mkdir(exist_ok=True)
            run = subprocess.run(["sh", "-c", 'rmdir "$PWD"; exec "$@"', "sh", IGSP, *arguments], cwd=gone,
                                 capture_output=True, text=True)
            self.assertEqual(run.returncode, 3, (arguments, run.stderr))
            self.assertEqual(run.stderr.count("\n"), 1, run.stderr)

    def test_too_little_memory(self):
        def run(megabytes, *arguments):
            limit = (megabytes << 20, megabytes << 20)
            return subprocess.run([IGSP, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit))

        least = next(size for size in range(8, 512, 8) if run(size, "--version").returncode == 0)
        codes, lines = set(), set()
        for more in [*range(0, 48, 4), 512]:
            done = run(least + more, "align", self.source, self.target, "--threads", "1", "-o", "a.ply", "--html", "r.html")
            codes.add(done.returncode)
            self.assertIn(done.returncode, [0, 3], done.stderr)
            self.assertEqual(done.stderr.count("\n"), int(done.returncode == 3), done.stderr)
            lines.add(done.stderr)
            self.assertLessEqual(set(os.listdir(self.folder)), {"a.ply", "r.html"})
        self.assertEqual(codes, {0, 3})
        self.assertIn("igsp: not enough memory for these clouds; a smaller --max-points streams them\n", lines)


if __name__ == "__main__":
    unittest.main()
