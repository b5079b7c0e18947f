#!/usr/bin/env python3
"""Finds words in src/, include/ and kit/ that would break a promise: the same bits everywhere, no unfinished code. In the names of
files, types, functions and variables of src/ and include/ it also finds words for which docs/glossary.md has a standard term.

An exception is a comment on the same line or the line above, with a reason:   // word-ok: <reason>
Comments and strings are not searched for code words and names. Tests are not searched at all.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

CODE_WORDS = [
    (r"\bstd::(sort|nth_element|partial_sort|partial_sort_copy|make_heap|push_heap|pop_heap|sort_heap|priority_queue)\b",
     "the order of equal elements differs between standard libraries; use base/container/sort"),
    (r"\bstd::(sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|expm1|pow|log|log2|log10|log1p|cbrt"
     r"|hypot|erf|erfc|tgamma|lgamma)f?\s*\(",
     "the last bit differs between C libraries; use math/trig"),
    (r"(?<![\w.:>])(::\s*)?(sinf|cosf|tanf|asinf|acosf|atanf|atan2f|expf|exp2f|powf|logf|log2f|log10f|cbrtf|hypotf)\s*\(",
     "the last bit differs between C libraries; use math/trig"),
    (r"(?<![\w>)\]])::\s*(sin|cos|tan|asin|acos|atan|atan2|exp|pow|log|hypot)\s*\(",
     "the last bit differs between C libraries; use math/trig"),
    (r"\bunordered_(map|set|multimap|multiset)\b", "its order differs between standard libraries; use base/container/flat_map"),
    (r"\bstd::hash\b", "differs between standard libraries; use base/hash"),
    (r"(?<![\w.:>])(std::)?s?rand\s*\(", "hidden global state"),
    (r"\bstd::(random_device|mt19937(_64)?|default_random_engine|uniform_\w+_distribution|normal_distribution|shuffle)\b",
     "differs between runs or standard libraries"),
    (r"\bstd::fmaf?\b|(?<![\w.:>])fmaf?\s*\(|__builtin_fmaf?\b", "a fused operation rounds once; the promise needs two roundings"),
    (r"\b_mm\d*_(mask_|maskz_|mask3_)?fn?m(add|sub|addsub|subadd)_\w+", "a fused operation rounds once"),
    (r"\bv(fma|fms|mla|mls)q?_(n_|lane_|laneq_)?f(16|32|64)\b", "a fused operation rounds once (and vmla may)"),
    (r"\b_mm\d*_(mask_|maskz_)?(rcp|rsqrt)\w*", "an estimate; its bits differ between processors"),
    (r"\bv(recpe|rsqrte|recps|rsqrts)q?_f(16|32|64)\b", "an estimate; its bits differ between processors"),
    (r"relaxed_(madd|nmadd|min|max|trunc)\w*", "relaxed operations differ between machines"),
    (r"ffast-math|fp:fast|#\s*pragma\s+(STDC\s+FP_CONTRACT|float_control|fp_contract|clang\s+fp)|fast-math",
     "changes floating-point results"),
    (r"\bstd::atomic\s*<\s*(float|double)\s*>", "float sums depend on the order of threads"),
    (r"\blong\s+double\b", "another size on every platform"),
    (r"\bstd::(execution|reduce|transform_reduce)\b|#\s*pragma\s+omp", "leaves the order of sums open"),
    (r"__DATE__|__TIME__", "the build would differ from day to day"),
    (r"\bstd::(bit_cast|jthread|stop_token|source_location|format|atomic_ref|pmr|ranges|assume_aligned)\b",
     "not in every supported standard library"),
]
ANY_WORDS = [
    (r"\b(TODO|FIXME|XXX|HACK|TBD)\b", "unfinished work does not go in"),
]
# Words of a name and the term to use instead (docs/glossary.md). "body_look" stands for body_look, BodyLook, body_looks and
# make_body_look; "k_most" for kMost and kMostSides. A new rename needs one more line here.
NAME_WORDS = {
    "awake_link": "active_constraint",
    "body_look": "collision_body",
    "body_place": "body_pose",
    "closing_way": "projection_path",
    "contact_aside": "contact_block_cold",
    "counted_list": "bucketed_list",
    "dense_net": "dense_graph_cache",
    "error_taken_back": "clamped_error",
    "forget_look": "invalidate_cache",
    "free_place": "free_slot",
    "goes_along": "is_simulated",
    "hurried": "moved_shapes",
    "hurry": "mark_moved",
    "idle_clock": "shrink_policy",
    "k_least": "kMin...",
    "k_most": "kMax...",
    "kept_state": "state_copy",
    "linkage": "articulation",
    "lone_solver": "worker_context",
    "look_anew": "compute_manifold",
    "net_joint": "joint_edge",
    "pulled": "geometric_stiffness, stiffened",
    "rounding_slack": "rounding_tolerance",
    "seam": "internal_edge",
    "shared_column": "interned_column",
    "spinner": "fast_spinning",
    "state_walk": "validate_state",
    "tried_step": "step_checkpoint",
    "whirl": "fast_spinning",
    "whirling": "fast_spinning",
    "worked_row": "actuated_row",
}
NAMED = ("include", "src")
# Tests and what only they include: gjk_test.cpp, wide_test_kernels.h, convex_oracle.h.
TESTS = re.compile(r"_(test|oracle)(_\w+)?\.(h|cpp)$")
ALLOW = re.compile(r"//\s*word-ok:\s*\S.{5,}")


def strip(text):
    """The text with comments and string contents blanked out, lines kept."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)

    def blank(match):
        return re.sub(r"[^\n]", " ", match.group(0))

    return pattern.sub(blank, text)


def words_of(name):
    """Its words in lower case, each with a _ on either side: _k_most_sides_ of kMostSides."""
    parts = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+", name)
    return "_" + "_".join(part.lower() for part in parts) + "_"


def old_words(name):
    """The entries of NAME_WORDS that the name contains, in the singular or in the plural."""
    words = words_of(name)
    return [old for old in NAME_WORDS if f"_{old}_" in words or f"_{old}s_" in words]


def check_names(path, lines, stripped):
    """Prints the old words in the name of a file and in the names in its code, each name once. Returns how many there are."""
    shown = path.relative_to(ROOT)
    problems = 0
    for old in old_words(path.name.split(".")[0]):
        print(f"{shown}: the name of the file has '{old}': use {NAME_WORDS[old]} (docs/glossary.md)")
        problems += 1
    seen = set()
    for i, line in enumerate(stripped):
        if ALLOW.search(lines[i]) or (i > 0 and ALLOW.search(lines[i - 1])) or line.lstrip().startswith("#include"):
            continue
        for name in re.findall(r"[A-Za-z_]\w*", line):
            if name in seen:
                continue
            seen.add(name)
            for old in old_words(name):
                print(f"{shown}:{i + 1}: the name '{name}' has '{old}': use {NAME_WORDS[old]} (docs/glossary.md)")
                problems += 1
    return problems


def check_test_namespaces():
    """Tests are compiled several files at once: gjk_test.cpp is in gyre::gjk_test. Returns how many files are elsewhere."""
    problems = 0
    for top in ("src", "scene", "formats", "kit", "bench", "apps", "tests"):
        for path in sorted((ROOT / top).rglob("*_test.cpp")):
            text = path.read_text(encoding="utf-8", errors="replace")
            if not re.search(rf"^namespace gyre(::\w+)*::{path.stem} {{$", text, re.M):
                print(f"{path.relative_to(ROOT)}: no namespace gyre::{path.stem}, so its helpers may clash with other tests'")
                problems += 1
    return problems


def main():
    code_words = [(re.compile(pattern), why) for pattern, why in CODE_WORDS]
    any_words = [(re.compile(pattern), why) for pattern, why in ANY_WORDS]
    problems = check_test_namespaces()
    count = 0
    for top in ("include", "src", "kit"):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cpp") or TESTS.search(path.name):
                continue
            count += 1
            text = path.read_text(encoding="utf-8", errors="replace")
            lines = text.split("\n")
            stripped = strip(text).split("\n")
            if top in NAMED:
                problems += check_names(path, lines, stripped)
            for i, line in enumerate(lines):
                found = [(p.search(stripped[i]), why) for p, why in code_words]
                found += [(p.search(line), why) for p, why in any_words]
                for match, why in found:
                    if not match or ALLOW.search(line) or (i > 0 and ALLOW.search(lines[i - 1])):
                        continue
                    print(f"{path.relative_to(ROOT)}:{i + 1}: '{match.group(0).strip()}': {why}")
                    problems += 1
    print(f"check_words: {count} files, {problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
