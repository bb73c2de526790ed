"""Draws all that a file has, each picture as PDF (or SVG) and PNG.

    python -m credence.pictures study.h5 -o pictures    # credence run -o study.h5
    python -m credence.pictures trial.h5 -o pictures    # credence replay ... -o trial.h5

Exit codes: 0 done, 2 bad input or nothing to draw, 130 interrupted.
"""

from __future__ import annotations

import argparse
import pathlib
import sys
from collections.abc import Sequence

try:
    from .._errors import Failure
    from .._outputs import check_output
    from . import program, style
    from .drawing import animate, plot
    from .jobs import FILM, KINDS, Job, jobs_of
except KeyboardInterrupt:
    sys.exit(130)
except ImportError as missing:
    print(f"credence.pictures: cannot draw ({missing}). Install python3-h5py, python3-scipy and python3-matplotlib "
          "(pip: h5py scipy matplotlib).", file=sys.stderr)
    sys.exit(2)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m credence.pictures",
                                     description="Pictures of a results file or a trajectory file of credence.")
    parser.add_argument("file", metavar="FILE.h5")
    parser.add_argument("-o", "--output", metavar="DIR", default="pictures", help="folder for them (default: pictures)")
    parser.add_argument("--overwrite", action="store_true", help="replace pictures that are there")
    parser.add_argument("--scenario", metavar="NAME", action="append", help="only this scenario; may be repeated")
    parser.add_argument("--arms", metavar="A,B,...", type=lambda text: [name.strip() for name in text.split(",")],
                        help="only these arms; of two, paired is A - B")
    parser.add_argument("--kind", choices=KINDS, action="append", help="only this kind; may be repeated")
    parser.add_argument("--trial", type=int, default=0, metavar="I",
                        help="the trial of --kind place and animation (default: 0)")
    parser.add_argument("--no-title", dest="title", action="store_false",
                        help="leave out the message and the line below the picture")
    parser.add_argument("--vector", choices=("pdf", "svg"), default="pdf", help="vector format (default: pdf)")
    parser.add_argument("--width", type=int, choices=(int(style.COLUMN), int(style.PAGE)), default=int(style.PAGE),
                        help="millimetres: a page (default) or a column")
    parser.add_argument("--ellipses", choices=("95", "1-sigma"), default="95",
                        help="ellipses of a trajectory: 95 %% (default) or 1-sigma")
    parser.add_argument("--credence", metavar="PATH", help="the program, which says the verdicts (default: the "
                        "package's compiled module, build/credence of a checkout, or that on the PATH)")
    return parser


def _files_of(job: Job, options: argparse.Namespace) -> list[pathlib.Path]:
    endings = ("gif",) if job[2] == FILM else (options.vector, "png")
    return [pathlib.Path(options.output, f"{job[0]}.{ending}") for ending in endings]


def _write(job: Job, options: argparse.Namespace) -> list[pathlib.Path]:
    """Draws a picture and returns its files."""
    _, what, kind, given = job
    paths = _files_of(job, options)
    if kind == FILM:
        paths[0].parent.mkdir(parents=True, exist_ok=True)
        return [animate(what, path=paths[0], **given)]
    picture = plot(what, kind, width=options.width, title=options.title, **given)
    paths[0].parent.mkdir(parents=True, exist_ok=True)
    for path in paths:
        picture.save(path)
    return paths


def main(arguments: Sequence[str]) -> int:
    options = _parser().parse_args(arguments)
    written = 0
    try:
        jobs, left_out = jobs_of(options)
        for job in jobs if pathlib.Path(options.output).is_dir() else ():
            for path in _files_of(job, options):
                check_output(path, options.overwrite, "Give --overwrite, or another folder", inputs=[options.file])
        for job in jobs:
            try:
                for path in _write(job, options):
                    print(path)
                    written += 1
            except program.NoProgram as reason:
                left_out.append(f"no picture of {job[2]}: {reason} Give --credence PATH.")
    except (OSError, ValueError, Failure) as problem:
        print(f"credence.pictures: {problem}", file=sys.stderr)
        return 2
    except KeyError as missing:
        print(f"credence.pictures: {options.file} is damaged ({missing}). Run the study again, or give an undamaged "
              "copy.", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"credence.pictures: interrupted ({written} files are written). Run it again.", file=sys.stderr)
        return 130
    if not written:
        print("credence.pictures:", " ".join(dict.fromkeys(left_out)), file=sys.stderr)
        return 2
    for sentence in dict.fromkeys(left_out):
        print(sentence, file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
