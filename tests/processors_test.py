"""The command gives the same bits on another processor, as far as qemu-user can show it without a cross compiler.

usage: processors_test.py IGSP
"""
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "scripts"))
import same_bits

PAIRS = [("park", "4000", ""), ("object", "4000", "")]


def test_an_x86_without_avx_and_fused_multiply_add(igsp, work):
    here = [*same_bits.PLAIN_LIBM, igsp]
    emulated = ["qemu-x86_64", "-cpu", "Nehalem", igsp]
    assert same_bits.scenes_agree(here, emulated, work, PAIRS)
    assert same_bits.answers_agree(here, emulated, work, PAIRS)


def main():
    if not shutil.which("qemu-x86_64"):
        print("SKIPPED: qemu-x86_64 (Debian: qemu-user) is not installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        test_an_x86_without_avx_and_fused_multiply_add(sys.argv[1], Path(folder))
    return 0


if __name__ == "__main__":
    sys.exit(main())
