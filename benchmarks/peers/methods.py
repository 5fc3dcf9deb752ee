"""What is run: every method, with which voxels, threads and seeds, and on which share of the pairs."""

from dataclasses import dataclass

ALL_THREADS = 0

# Voxel sizes that the peers' own examples use for data of the kind [m]; their documents give no rule for other scenes.
OPEN3D_VOXELS = {"redkitchen": 0.05, "livingroom": 0.05, "apartment": 0.05}
OUTDOOR_VOXELS = {"facade": 0.3, "road": 0.3}
SMALL_GICP_VOXELS = {"facade": 0.25, "road": 0.25}


@dataclass(frozen=True)
class Method:
    """`program` is how it is started: igsp, pcl, or the Python module of that name."""

    name: str
    program: str
    method: str = ""
    seeds: int = 1  # runs, for the stochastic ones
    every: int = 1  # of the pairs, for the slow ones
    every_threads: int = 4  # the same for the run on all threads, of those that overlap
    time_limit_s: int = 60  # CPU of the process; a third of it by the clock for what limits itself
    recommended: tuple[tuple[str, float], ...] = ()  # voxel size by group
    from_guess: bool = False  # a fine registration: starts from the perturbed truth

    def recommended_for(self, group: str) -> float | None:
        return dict(self.recommended).get(group)


def _table(table: dict[str, float]) -> tuple[tuple[str, float], ...]:
    return tuple(table.items())


METHODS = [
    Method("igsp", "igsp", "default"),
    Method("igsp_paper", "igsp", "paper"),
    Method("open3d_ransac_100k", "open3d_peer", "ransac_100k", seeds=3, recommended=_table(OPEN3D_VOXELS)),
    Method("open3d_fgr", "open3d_peer", "fgr", seeds=3, recommended=_table(OPEN3D_VOXELS)),
    Method("kiss_matcher", "kiss_matcher_peer", recommended=_table(OUTDOOR_VOXELS)),
    Method("pcl_geometric_consistency", "pcl", "geometric_consistency"),
    Method("pcl_kfpcs", "pcl", "kfpcs", seeds=3),
    Method("pcl_icp", "pcl", "icp"),
    Method("pcl_ndt", "pcl", "ndt"),
    Method("igsp_refine", "igsp", "default", from_guess=True),
    Method("small_gicp_refine", "small_gicp_peer", from_guess=True, recommended=_table(SMALL_GICP_VOXELS)),
    Method("pcl_prerejective", "pcl", "prerejective", seeds=3, every=4, every_threads=16),
    Method("open3d_ransac_4m", "open3d_peer", "ransac_4m", every=8, every_threads=32, time_limit_s=180),
]


@dataclass(frozen=True)
class Run:
    """One process on one pair."""

    method: Method
    voxels: str  # "igsp": the size that igsp chose; "recommended": the peer's own
    threads: int
    seed: int

    @property
    def threads_text(self) -> str:
        return str(self.threads or "all")

    @property
    def seed_text(self) -> str:
        return str(self.seed) if self.method.seeds > 1 else ""


def wanted(run: Run, number: int, every: int, share: int, negative: bool) -> bool:
    """Whether the pair with this number in its group belongs to the sample. Of the pairs that do not overlap, `every`
    spares none: each may be a false accept."""
    if negative:
        return not run.method.from_guess and run.threads != ALL_THREADS and number % share == 0
    return number % (every * share) == 0


def rounds(methods: list[Method]) -> list[list[tuple[Run, int]]]:
    """Passes over all pairs, the most telling first, so that a run which is stopped leaves whole tables. With each run
    the share of pairs it is wanted for: one of so many."""
    slow = [m for m in methods if m.every > 1]
    quick = [m for m in methods if m.every == 1]

    def one_thread(of: list[Method], seed: int) -> list[tuple[Run, int]]:
        return [(Run(m, "igsp", 1, seed), m.every) for m in of if m.seeds >= seed]

    def all_threads(of: list[Method]) -> list[tuple[Run, int]]:
        return [(Run(m, "igsp", ALL_THREADS, 1), max(m.every, m.every_threads)) for m in of]

    own_voxels = [(Run(m, "recommended", 1, 1), m.every) for m in methods if m.recommended]
    return [one_thread(quick, 1), one_thread(quick, 2), own_voxels, one_thread(slow, 1), all_threads(quick),
            one_thread(quick, 3), one_thread(slow, 2), one_thread(slow, 3), all_threads(slow)]
