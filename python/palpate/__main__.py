"""`python -m palpate`: the command."""

import sys

from palpate import main

sys.exit(main())
