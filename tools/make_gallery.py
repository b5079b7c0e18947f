#!/usr/bin/env python3
"""Draws every scene in scenes/, scenes/soft/ and scenes/fluid/ with `gyre render`: the gallery in docs/, or thumbnails.

    tools/make_gallery.py                      writes docs/gallery.md and docs/pictures/
    tools/make_gallery.py stack pile           draws only these two anew
    tools/make_gallery.py --thumbnails FOLDER  writes FOLDER/<scene>.png, 240 x 150 pixels, instead
    tools/make_gallery.py --check              fails if a scene is not in the gallery, or the pictures are too large

--gyre PATH is the program, build/release/bin/gyre if not given.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ROOT / "scenes"
PAGE = ROOT / "docs" / "gallery.md"
PICTURES = ROOT / "docs" / "pictures"
MOST_BYTES = 6_400_000  # all pictures together
MOST_BYTES_OF_ONE = 450_000

MOVIE = "--size 360x225 --fps 12.5"
SMALL = "--size 300x188 --fps 8"  # of ropes, cloth, solids, gases and liquids, where much of the picture moves
PICTURE = "--size 480x300"

# What each scene shows, and the options of its picture. A scene that is not here is drawn by the last line.
ENTRIES = {
    "showcase": ("Some of everything: bricks, dominoes, a pit of mixed shapes, hills of triangles and a ball on a chain.",
                 "movie", "--from 0.6 --seconds 3"),
    "fluid/all_matter": ("Rigid bodies, a rope, a cloth, a solid, a liquid and a gas that burns.", "picture", "--at 1.2"),
    "pile": ("Spheres, boxes, capsules, cylinders, cones and hulls fall into a pit. The front walls are drawn as glass.",
             "movie", "--seconds 3"),
    "dominoes": ("Each domino tips the next. The colours only show the order.", "movie", "--seconds 5 --speed 2.5"),
    "bowling": ("A ball with side spin hits ten pins. Each pin is two hulls and a sphere.", "movie", "--from 0.6 --seconds 3"),
    "billiards": ("The break in slow motion, at 240 steps a second. A table of material pairs gives the friction and restitution of "
                  "balls, cloth and cushions.", "movie", "--from 0.05 --seconds 4 --speed 0.5"),
    "bridge": ("Twenty-one hinges hold twenty planks and their load.", "movie", "--seconds 3"),
    "chain": ("A chain of ball joints pulls a ball 130 times as heavy as a link.", "movie", "--seconds 4"),
    "machines": ("A driven hinge, a slider on a spring, a gate with limits, a coil spring, a rocket, and a kinematic "
                 "mixer.", "movie", "--seconds 4"),
    "newtons_cradle": ("Five balls on ten rods, with restitution 1.", "movie", "--seconds 3"),
    "bouncing": ("Restitution from 0 on the left to 1 on the right. The last ball bounces for ever.", "movie", "--seconds 5"),
    "incline_materials": ("Friction decides which boxes stay on a slope of 22 degrees: above tan 22 = 0.40, no box slides.",
                          "movie", "--seconds 3"),
    "belt": ("Two belts run at 2 m/s and at 1 m/s the other way. Crates slip by Coulomb friction until they have the speed of the belt.",
             "picture", "--at 1.2"),
    "one_way": ("One-way platforms let bodies pass upward and hold them from above.", "picture", "--at 0.45"),
    "half_wood_half_lead": ("Bricks have two halves of different density. The centre of mass decides which of them tip.",
                            "movie", "--seconds 2"),
    "rolling": ("A ball, a cylinder, a capsule and a hollow cylinder race down a ramp; a cone rolls around its apex, a coin spins.",
                "movie", "--seconds 6"),
    "gyroscope": ("A heavy top precesses about its pivot.", "movie", "--seconds 5"),
    "t_handle": ("Without gravity, a body that spins about its middle axis flips again and again.", "movie",
                 "--seconds 6"),
    "mesh_terrain": ("A hundred and twenty pieces lie on a triangle mesh.", "movie", "--seconds 3"),
    "height_field": ("Sixty pieces lie on a height field.", "picture", "--at 3"),
    "card_house": ("Friction alone holds fifteen cards.", "picture", "--at 5"),
    "stack": ("A tower of ten boxes stands for any time.", "picture", "--at 5"),
    "soft/flag": ("A cloth in gusts of wind.", "small", "--from 1 --seconds 3"),
    "soft/curtain_through_ring": ("A sheet of 1.4 m goes through a ring of 26 cm.", "small", "--seconds 4 --speed 1.5"),
    "soft/cloth_on_spikes": ("A cloth falls on five spikes with rounded tips.", "small", "--seconds 2.5"),
    "soft/cloth_on_sphere": ("A cloth falls over a sphere.", "picture", "--at 2"),
    "soft/twisted_towel": ("A towel winds up on itself and lifts the lower bar.", "small", "--seconds 4 --speed 2.5"),
    "soft/sheets_on_cylinder": ("Ten sheets fall over a cylinder and lie in layers.", "small", "--seconds 3"),
    "soft/bag_of_balls": ("Four clips lift the corners of a cloth and draw them together. The balls stay in the bag.", "small", "--seconds 4 --speed 2.5"),
    "soft/tearing_banner": ("Balls tear a cloth along its edges.", "small", "--seconds 2.5"),
    "soft/rope_bridge": ("Planks hang on four ropes, and a ball rolls over them.", "picture", "--at 3"),
    "soft/rope_bridge_with_car": ("A car on four sprung wheels crosses a bridge of ropes and planks.", "small", "--seconds 4 --speed 2"),
    "soft/crane": ("A ball of 565 kg hangs on a rope of 4 kg.", "small", "--seconds 3"),
    "soft/jelly": ("A ball rests on a solid of rubber.", "picture", "--at 2"),
    "soft/jelly_stack": ("A ball of 84 kg falls on three solids of rubber.", "small", "--seconds 3"),
    "soft/broken_plate": ("A plate breaks over a rod, which is drawn as glass. Its pieces lie on each other.", "small", "--from 0.2 --seconds 1.6 --speed 0.7"),
    "soft/untangling": ("Two sheets begin halfway through each other and part.", "small", "--seconds 2"),
    "soft/integrators": ("One chain of springs with each integrator. Explicit Euler gains energy.", "picture", "--at 1"),
    "fluid/smoke_fan": ("A fan draws in smoke and blows it ahead.", "small", "--from 1 --seconds 3"),
    "fluid/candle": ("The warm plume of a candle carries its smoke up and moves a vane.", "small", "--from 1 --seconds 3"),
    "fluid/fire_and_wind_on_a_flag": ("A fan bends the flame of a burner towards a flag. Fuel becomes heat, and heat rises.", "small",
                                      "--from 0.25 --seconds 2.5"),
    "fluid/flag_in_fan_wind": ("A cloth in the wind of a fan: rigid body, gas and cloth in one.", "picture", "--at 1.35"),
    "fluid/vortex_street": ("The plane flow past a cylinder at Re 150: vortices leave on both sides in turn.", "small", "--from 10 --seconds 1.5"),
    "fluid/lid_driven_cavity": ("A lid drags the air of a closed box round at Re 400.", "picture", "--at 6"),
    "fluid/dam_break": ("A column of water falls and sweeps crates along.", "small", "--seconds 2.5"),
    "fluid/harbour": ("A ship, and boxes of 200 to 2600 kg/m^3.", "small", "--seconds 3"),
    "fluid/five_densities": ("Boxes of 100 to 900 kg/m^3. Each floats as deep as its density says; those of 300, 500 and 700 kg/m^3 tip, as they must.",
                             "picture", "--at 2"),
    "fluid/honey": ("Honey of 200 Pa s runs slowly over a ball.", "small", "--seconds 3"),
    "fluid/communicating_vessels": ("Water passes under a divider until both levels are the same.", "picture", "--at 0.5"),
    "fluid/scoop_wheel": ("Cups on a wheel dip into water and lift it.", "small", "--from 1 --seconds 3"),
}
ELSE = ("", "picture", "--at 2")


def scene_names():
    """Those of the table first, in its order."""
    paths = [path for folder in ("", "soft/", "fluid/") for path in SCENES.glob(f"{folder}*.gyre.json")]
    there = sorted(path.relative_to(SCENES).as_posix().removesuffix(".gyre.json") for path in paths)
    return [name for name in ENTRIES if name in there] + [name for name in there if name not in ENTRIES]


def picture_of(name):
    words, kind, options = ENTRIES.get(name, ELSE)
    ending, common = {"movie": ("gif", MOVIE), "small": ("gif", SMALL), "picture": ("png", PICTURE)}[kind]
    return words, PICTURES / f"{name.replace('/', '_')}.{ending}", f"{common} {options}"


def draw(gyre, name, out, options):
    command = [gyre, "render", str(SCENES / f"{name}.gyre.json"), "--out", str(out), *options.split()]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")
    print(done.stdout.strip())


def page_text():
    parts = ["# Gallery", "",
             "`gyre render` draws every scene in [scenes/](../scenes) without a graphics card. `tools/make_gallery.py` makes this page.",
             "The command that draws a picture is below it. `./run SCENE --live` shows a scene from all sides."]
    for name in scene_names():
        words, picture, options = picture_of(name)
        title = json.loads((SCENES / f"{name}.gyre.json").read_text(encoding="utf-8"))["name"]
        parts += ["", f"## {title[0].upper()}{title[1:]}", "", f"![{title}](pictures/{picture.name})", ""]
        parts += [words, ""] if words else []
        parts += [f"`gyre render scenes/{name}.gyre.json --out {picture.name} {options}`"]
    return "\n".join(parts) + "\n"


def check():
    problems = []
    if not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != page_text():
        problems.append(f"{PAGE.relative_to(ROOT)} is not what this script writes")
    pictures = [picture_of(name)[1] for name in scene_names()]
    problems += [f"{path.relative_to(ROOT)} is missing" for path in pictures if not path.is_file()]
    problems += [f"{path.relative_to(ROOT)} belongs to no scene" for path in PICTURES.glob("*") if path not in pictures]
    problems += [f"{path.relative_to(ROOT)} has more than {MOST_BYTES_OF_ONE} bytes"
                 for path in pictures if path.is_file() and path.stat().st_size > MOST_BYTES_OF_ONE]
    size = sum(path.stat().st_size for path in PICTURES.glob("*"))
    if size > MOST_BYTES:
        problems.append(f"the pictures have {size} bytes together, more than {MOST_BYTES}")
    for problem in problems:
        print(f"{problem}; run tools/make_gallery.py")
    print(f"make_gallery: {len(pictures)} pictures, {size / 1e6:.2f} MB, {len(problems)} problems")
    return 1 if problems else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    parser.add_argument("--gyre", default=str(ROOT / "build" / "release" / "bin" / "gyre"), metavar="PATH")
    parser.add_argument("--thumbnails", metavar="FOLDER")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.scenes) - set(scene_names()))
    if unknown:
        sys.exit(f"no such scene: {', '.join(unknown)}")
    if arguments.check:
        return check()
    names = arguments.scenes or scene_names()
    if arguments.thumbnails:
        folder = Path(arguments.thumbnails)
        folder.mkdir(parents=True, exist_ok=True)
        for name in names:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            draw(arguments.gyre, name, folder / f"{name}.png", "--size 240x150 --at 1.5 --samples 24")
        return 0
    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names:
        _, picture, options = picture_of(name)
        draw(arguments.gyre, name, picture, options)
    PAGE.write_text(page_text(), encoding="utf-8")
    return check()


if __name__ == "__main__":
    sys.exit(main())
