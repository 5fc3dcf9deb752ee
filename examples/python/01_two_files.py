"""Two files, one call: 01_two_files.py SOURCE TARGET"""

import sys

import igsp

result = igsp.align(sys.argv[1], sys.argv[2]).raise_if_not_registered()
print(result)
print(result.target_from_source)  # (4, 4): p_target = target_from_source * p_source
