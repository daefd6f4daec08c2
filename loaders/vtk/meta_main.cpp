/// palpate-load-meta: MetaImage volumes for the explorers.
#include "loaders/vtk/meta_loader.h"

int main() { return palpate::serve_loader(*palpate::make_meta_loader()); }
