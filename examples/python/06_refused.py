"""A pair that cannot be registered, and why."""

import igsp

target, source = (scan.points for scan in igsp.simulate("park", points=60000, seed=1))
left_handed = source * [1, -1, 1]  # as some programs export

result = igsp.align(left_handed, target)
print(result)
assert not result.registered
for cause in igsp.diagnose(left_handed, target, result):
    print(cause)
