#!/usr/bin/env python3
"""check_kernels.py BUILD_FOLDER: no kernel object may offer a shared function that was compiled for a wider processor.

An inline function that the compiler did not inline is emitted in every object that uses it, and the linker keeps one copy
for all. If that copy came from an AVX2 file, an older processor would run into it outside the kernels. So whatever such an object
defines weakly must live in the namespace of its target (GYRE_TARGET_NAMESPACE, which ends in the target's name).
"""

import re
import subprocess
import sys
from pathlib import Path

KERNEL = re.compile(r"_kernels_(avx2|avx512|avx512vl)\.cpp\.(o|obj)$")


def main():
    build = Path(sys.argv[1])
    objects = [path for path in sorted((build / "src").rglob("*")) if KERNEL.search(path.name)]
    problems = 0
    for path in objects:
        target = KERNEL.search(path.name).group(1)
        done = subprocess.run(["nm", "-C", "--defined-only", str(path)], capture_output=True, text=True, check=True)
        for line in done.stdout.splitlines():
            match = re.match(r"^[0-9a-f]+ ([A-Za-z]) (.*)$", line)
            if match and match.group(1) in "WVu" and not re.search(rf"\b\w+_{target}::", match.group(2)):
                print(f"{path.name}: shares '{match.group(2)}', compiled for {target}")
                problems += 1
            if match and "_GLOBAL__sub_I" in line:
                print(f"{path.name}: runs {target} code when the program starts (a table that is not constant)")
                problems += 1
    print(f"check_kernels: {len(objects)} objects, {problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
