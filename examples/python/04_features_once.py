"""One scan against many: what depends on a cloud alone is computed once. 04_features_once.py TARGET SOURCE..."""

import sys

import igsp

target = igsp.extract_features(sys.argv[1], voxel_size=0.5)
igsp.write_features("target.features", target)  # for another process, another day

results = {path: igsp.align(path, target) for path in sys.argv[2:]}
for path, result in results.items():
    print(f"{path}: {result}")
sys.exit(sum(not result.registered for result in results.values()))
