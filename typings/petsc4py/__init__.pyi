from . import PETSc as PETSc
