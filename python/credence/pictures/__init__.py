"""Pictures of credence's files. plot.py makes them all; each function draws one figure and returns it."""
