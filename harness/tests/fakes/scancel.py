#!/usr/bin/env python3
"""Stands for scancel: `scancel ID...`."""
import os
import sys

here = os.path.dirname(os.path.abspath(__file__))
for job in sys.argv[1:]:
    open(os.path.join(here, f"{job}.cancel"), "w").close()
