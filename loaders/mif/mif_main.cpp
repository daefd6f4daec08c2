/// palpate-load-mif: MRtrix's images for the explorers.
#include "loaders/mif/mif_loader.h"

int main() { return palpate::serve_loader(*palpate::make_mif_loader()); }
