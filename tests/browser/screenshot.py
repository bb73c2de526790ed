#!/usr/bin/env python3
"""screenshot.py PAGE.html OUT.png|OUT.pdf [--width 1200] [--height 900] [--top 0] [--scheme light|dark]: a picture."""
import argparse

from browser import Browser

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("page")
parser.add_argument("out")
parser.add_argument("--width", type=int, default=1200)
parser.add_argument("--height", type=int, default=900)
parser.add_argument("--top", default="0", help="pixels from the page's top, or the id of an element")
parser.add_argument("--scheme", choices=["light", "dark"], default="light")
given = parser.parse_args()

with Browser() as browser:
    browser.look(given.width, given.height, given.scheme)
    browser.open(given.page)
    if given.out.endswith(".pdf"):
        browser.pdf(given.out)
    else:
        top = (
            int(given.top)
            if given.top.isdigit()
            else browser.evaluate(f"document.getElementById('{given.top}').getBoundingClientRect().top + scrollY")
        )
        browser.screenshot(given.out, top, given.height)
