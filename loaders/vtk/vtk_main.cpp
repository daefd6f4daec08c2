/// palpate-load-vtk: VTK's own formats for the explorers.
#include "loaders/vtk/vtk_files.h"

int main() { return palpate::serve_loader(*palpate::make_vtk_loader()); }
