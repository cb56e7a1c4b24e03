from . import SLEPc as SLEPc
