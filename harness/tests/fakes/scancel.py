#!/usr/bin/env python3
"""Stands for scancel: `scancel ID...`."""
import sys

import places

places.cancel(sys.argv[1:])
