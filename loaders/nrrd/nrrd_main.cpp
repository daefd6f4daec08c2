/// palpate-load-nrrd: NRRD images for the explorers.
#include "loaders/nrrd/nrrd_loader.h"

int main() { return palpate::serve_loader(*palpate::make_nrrd_loader()); }
