"""Where the scanners stood, said or found: 05_viewpoints.py SOURCE TARGET"""

import sys

import igsp

for path in sys.argv[1:]:
    found = igsp.find_viewpoint(path)  # what the file says, else its origin if the cloud looks like one scan from there
    print(path, found.viewpoint, found.reason)

result = igsp.align(sys.argv[1], sys.argv[2])  # does the same by itself
print(result.source.viewpoint, result.target.viewpoint, result.reason)
result = igsp.align(sys.argv[1], sys.argv[2], source_viewpoint=[0, 0, 0], target_viewpoint=None)  # or say it
sys.exit(not result.registered)
