"""The Debian packages as a user meets them: their fields, an installation by dpkg into a root of its own, the command
and the library from there, and removal. usage: package_test.py BUILD_FOLDER [unittest arguments]

Needs dpkg-dev; the installation also needs root or fakeroot, and is reported as skipped without.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD = Path(sys.argv.pop(1))
SOURCE = Path(__file__).resolve().parent.parent
CACHE = dict(re.findall(r"^(\w+):\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.MULTILINE))
ENVIRONMENT = dict(os.environ, LC_ALL="C.UTF-8", PATH=os.environ["PATH"] + ":/usr/sbin:/sbin")


def run(*command: str | Path, **keywords) -> str:
    """Standard output of a command that must succeed; what it said otherwise."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True, env=ENVIRONMENT, **keywords)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def field(package: Path, name: str) -> str:
    return run("dpkg-deb", "-f", package, name).strip()


def depends(package: Path) -> set[str]:
    return {entry.split()[0].split(":")[0] for entry in field(package, "Depends").split(",")}


def setUpModule() -> None:
    global FOLDER, COMMAND, DEVELOPMENT
    if not shutil.which("dpkg-shlibdeps"):
        raise unittest.SkipTest("dpkg-shlibdeps (Debian package dpkg-dev) is not there")
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    FOLDER = Path(folder.name)
    run(shutil.which("cpack", path=str(Path(CACHE["CMAKE_COMMAND"]).parent)), "--config", BUILD / "CPackConfig.cmake",
        "-B", FOLDER)
    (COMMAND,) = FOLDER.glob("igsp_*.deb")
    (DEVELOPMENT,) = FOLDER.glob("libigsp-dev_*.deb")


class Fields(unittest.TestCase):
    def test_version_is_the_projects(self):
        version = CACHE["CMAKE_PROJECT_VERSION"]
        for package in (COMMAND, DEVELOPMENT):
            self.assertEqual(field(package, "Version"), version)
            self.assertIn(f"_{version}_", package.name)

    def test_the_command_depends_on_the_packages_of_the_libraries_it_loads(self):
        run("dpkg-deb", "-x", COMMAND, FOLDER / "fields")
        needed = re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", FOLDER / "fields/usr/bin/igsp"))
        self.assertIn("libtbb.so.12", needed)
        for library in needed:
            owners = {line.split(":")[0] for line in run("dpkg", "-S", f"*/{library}").splitlines()}
            self.assertTrue(owners & depends(COMMAND), f"{library} is in {owners}, not in {depends(COMMAND)}")
        self.assertFalse([name for name in depends(COMMAND) if name.endswith("-dev")])

    def test_the_library_depends_on_what_its_headers_and_its_cmake_package_ask_for(self):
        self.assertEqual(depends(DEVELOPMENT), {"libeigen3-dev", "libtbb-dev", "libfmt-dev", "liblzf-dev"})
        for name in depends(DEVELOPMENT):
            self.assertIn(name, (SOURCE / "scripts/setup.sh").read_text())

    def test_no_path_of_the_build_is_in_the_packages(self):
        for package in (COMMAND, DEVELOPMENT):
            run("dpkg-deb", "-x", package, FOLDER / "paths")
        for path in (FOLDER / "paths").rglob("*"):
            if path.is_file() and path.suffix in (".cmake", ".hpp"):
                self.assertNotIn(str(SOURCE), path.read_text(), path)
        self.assertNotIn("RUNPATH", run("objdump", "-p", FOLDER / "paths/usr/bin/igsp"))


class Installation(unittest.TestCase):
    """dpkg installs into a root whose database says what this machine has, so that it checks the dependencies."""

    @classmethod
    def setUpClass(cls):
        cls.prefix = [] if os.geteuid() == 0 else ["fakeroot"]
        if cls.prefix and not shutil.which("fakeroot"):
            raise unittest.SkipTest("neither root nor fakeroot: dpkg cannot install")
        cls.root = FOLDER / "root"
        for name in ("info", "updates", "triggers"):
            (cls.root / "var/lib/dpkg" / name).mkdir(parents=True)
        status = Path("/var/lib/dpkg/status").read_text()
        own = re.compile(r"^Package: (lib)?igsp(-dev)?$", re.MULTILINE)  # they may be installed on this machine
        others = [entry for entry in status.split("\n\n") if entry.strip() and not own.search(entry)]
        (cls.root / "var/lib/dpkg/status").write_text("\n\n".join(others) + "\n\n")
        cls.dpkg("--install", COMMAND, DEVELOPMENT)

    @classmethod
    def dpkg(cls, *arguments: str | Path) -> str:
        log = FOLDER / "dpkg.log"
        return run(*cls.prefix, "dpkg", "--root", cls.root, "--log", log, "--force-not-root", *arguments)

    def igsp(self, *arguments: str) -> str:
        return run(self.root / "usr/bin/igsp", *arguments, cwd=FOLDER)

    def test_1_the_packages_are_installed(self):
        listed = self.dpkg("-l", "igsp", "libigsp-dev")
        self.assertRegex(listed, r"(?m)^ii\s+igsp\s")
        self.assertRegex(listed, r"(?m)^ii\s+libigsp-dev")

    def test_2_the_command_aligns(self):
        self.assertNotIn("not found", run("ldd", self.root / "usr/bin/igsp"))
        self.igsp("simulate", "park", "--out", "scans", "--points", "60000")
        answer = self.igsp("align", "scans/station_1.ply", "scans/station_0.ply")
        self.assertTrue(answer.startswith("registered: "), answer)

    def test_3_manual_page_completion_and_licence_are_where_debian_looks(self):
        share = self.root / "usr/share"
        for path in ("man/man1/igsp.1.gz", "bash-completion/completions/igsp", "zsh/vendor-completions/_igsp",
                     "fish/vendor_completions.d/igsp.fish", "doc/igsp/copyright", "doc/igsp/CHANGELOG.md",
                     "doc/libigsp-dev/copyright"):
            self.assertGreater((share / path).stat().st_size, 500, path)

    def test_4_a_consumer_builds_against_the_library(self):
        build = FOLDER / "consumer"
        cmake = CACHE["CMAKE_COMMAND"]
        run(cmake, "-S", SOURCE / "tests/consumer", "-B", build, f"-DCMAKE_PREFIX_PATH={self.root / 'usr'}",
            "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_COMPILER={CACHE['CMAKE_CXX_COMPILER']}",
            f"-DCMAKE_CXX_FLAGS={CACHE['CMAKE_CXX_FLAGS']}")
        self.assertIn(str(self.root), (build / "CMakeCache.txt").read_text())
        run(cmake, "--build", build)
        run(build / "consumer", cwd=FOLDER)

    def test_5_removal_leaves_nothing(self):
        self.dpkg("--purge", "libigsp-dev", "igsp")
        left = [path for path in (self.root / "usr").rglob("*") if path.is_file()]
        self.assertEqual(left, [])


if __name__ == "__main__":
    unittest.main()
