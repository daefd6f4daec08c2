/// palpate-load-solver: PLOT3D, Exodus II, EnSight and OpenFOAM for the explorers.
#include "loaders/vtk/solver_readers.h"

int main() { return palpate::serve_loader(*palpate::make_solver_loader()); }
