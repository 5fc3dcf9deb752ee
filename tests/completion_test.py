"""Completion completes in a real bash, zsh and fish, and the manual page is complete and clean.
usage: completion_test.py IGSP [unittest arguments]. Of a shell or mandoc that is not there the tests are reported as
skipped.
"""
import fcntl
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import unittest
from pathlib import Path

IGSP = os.path.abspath(sys.argv.pop(1))
ENVIRONMENT = {"HOME": "/nonexistent", "PATH": f"{Path(IGSP).parent}:/usr/bin:/bin", "LC_ALL": "C.UTF-8",
               "TERM": "dumb"}


def run(*command: str, **keywords) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True, env=ENVIRONMENT, **keywords).stdout


def flags_in(text: str) -> set[str]:
    """What --help lists in its left column."""
    left = re.findall(r"^  (-\S+)", text, re.MULTILINE)
    return {name for names in left for name in names.split(",")}


SUBCOMMANDS = re.findall(r"^  (\w+)  ", run(IGSP, "--help").split("Subcommands:")[1], re.MULTILINE)
HELP = {name: run(IGSP, name, "--help") for name in SUBCOMMANDS}


class ShellTest:
    """What every shell must offer; a subclass says how its shell is asked."""

    shell: str

    def setUp(self):
        if not shutil.which(self.shell):
            self.skipTest(f"{self.shell} is not there")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "completion").write_text(run(IGSP, "completion", self.shell))
        (self.folder / "scan one.ply").touch()
        (self.folder / "scans").mkdir()

    def test_subcommands(self):
        self.assertEqual(self.offered("igsp al"), {"align"})
        self.assertEqual(self.offered("igsp ") & set(SUBCOMMANDS), set(SUBCOMMANDS))

    def test_every_long_flag_of_every_subcommand(self):
        for name in SUBCOMMANDS:
            expected = {flag for flag in flags_in(HELP[name]) if flag.startswith("--")}
            self.assertEqual({flag.rstrip("=") for flag in self.offered(f"igsp {name} --")}, expected, name)

    def test_choices(self):
        self.assertEqual(self.offered("igsp align --preset "), {"default", "paper"})
        self.assertEqual(self.offered("igsp align --dof "), {"4", "6"})
        self.assertEqual(self.offered("igsp align --search d"), {"direct"})
        self.assertEqual(self.offered("igsp simulate "), {"park", "indoor", "object"})
        self.assertEqual(self.offered("igsp completion "), {"bash", "zsh", "fish"})

    def test_files_and_folders(self):
        plain = {name.replace("\\", "").rstrip("/") for name in self.offered("igsp align sca")}
        self.assertEqual(plain, {"scan one.ply", "scans"})
        self.assertIn("scans", {name.rstrip("/") for name in self.offered("igsp simulate park --out s")})
        self.assertNotIn("scan one.ply", self.offered("igsp simulate park --out s"))

    def test_a_number_is_not_guessed(self):
        self.assertEqual(self.offered("igsp align --threads "), set())


class Bash(ShellTest, unittest.TestCase):
    shell = "bash"

    def offered(self, line: str) -> set[str]:
        words = re.findall(r"=|[^\s=]+", line) + ([""] if line.endswith(" ") else [])
        script = ('source ./completion; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); '
                  'function=$(complete -p igsp | sed "s/.*-F \\([^ ]*\\).*/\\1/"); $function; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        reply = run("bash", "--norc", "-c", script, "bash", *words, cwd=self.folder)
        return {word for word in reply.splitlines() if word}

    def test_value_after_an_equals_sign(self):
        self.assertEqual(self.offered("igsp align --preset="), {"default", "paper"})
        self.assertEqual(self.offered("igsp align --preset=p"), {"paper"})


class Fish(ShellTest, unittest.TestCase):
    shell = "fish"

    def offered(self, line: str) -> set[str]:
        reply = run("fish", "--no-config", "-c", f"source ./completion; complete -C '{line}'", cwd=self.folder)
        return {entry.split("\t")[0] for entry in reply.splitlines()}


class Zsh(ShellTest, unittest.TestCase):
    shell = "zsh"

    SETUP = ("PS1=; LISTMAX=1000; autoload -Uz compinit; compinit -u -D; source ./completion; "
             "bindkey '^I' list-choices; finish() { print FINISHED; exit }; zle -N finish; bindkey '^X' finish; "
             "print RE''ADY\n")

    def offered(self, line: str) -> set[str]:
        """What a zsh in a terminal of its own lists when Tab is pressed after the line."""
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.folder)
            os.execve(shutil.which("zsh"), ["zsh", "-f", "-i"], ENVIRONMENT)
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 300, 400, 0, 0))
        os.write(terminal, self.SETUP.encode())
        self.read_until(terminal, "READY")
        os.write(terminal, (line + "\t\x18").encode())
        listing = self.read_until(terminal, "FINISHED")
        os.close(terminal)
        os.waitpid(process, 0)
        rows = [row.strip() for row in listing.split("\n")[1:] if not row.startswith(line) and "\x1b" not in row]
        entries = [entry for row in rows for entry in re.split(r"\s{2,}", re.sub(r"\s+-- .*", "", row))]
        return {entry for entry in entries if entry}

    @staticmethod
    def read_until(terminal: int, word: str) -> str:
        text = b""
        while word.encode() not in text:
            text += os.read(terminal, 65536)
        return text.decode().replace("\r", "")


class UnknownShell(unittest.TestCase):
    def test_the_known_ones_are_named(self):
        refused = subprocess.run([IGSP, "completion", "tcsh"], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertEqual(refused.stderr, 'igsp: SHELL is "tcsh"; it must be one of bash, zsh, fish\n')


class Manual(unittest.TestCase):
    def test_it_names_every_flag_with_its_help(self):
        page = run(IGSP, "manual")
        text = re.sub(r"\\f.", "", page).replace("\\-", "-").replace("\\(aq", "'").replace("\\(ga", "`")
        for name in SUBCOMMANDS:
            self.assertIn(f".SS igsp {name}\n", text)
            section = text.split(f".SS igsp {name}\n")[1].split(".SS igsp")[0] + text.split(".SH METHOD OPTIONS")[1]
            for flag in flags_in(HELP[name]):
                self.assertRegex(section, rf"(?m)^(-\w, )?{re.escape(flag)}(,? |$)", f"igsp {name}")
        self.assertIn("principal component analysis [voxels]", " ".join(text.split()))

    def test_mandoc_has_nothing_to_say(self):
        if not shutil.which("mandoc"):
            self.skipTest("mandoc is not there")
        said = subprocess.run(["mandoc", "-T", "lint"], input=run(IGSP, "manual"), capture_output=True, text=True)
        self.assertEqual(said.stdout + said.stderr, "")

    def test_man_shows_it_without_warnings(self):
        if not shutil.which("man"):
            self.skipTest("man is not there")
        shown = subprocess.run(["man", "--warnings", "-l", "-"], input=run(IGSP, "manual"), capture_output=True,
                               text=True, env=ENVIRONMENT)
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))
        self.assertIn("igsp align [OPTIONS] SOURCE TARGET", shown.stdout)


if __name__ == "__main__":
    unittest.main()
