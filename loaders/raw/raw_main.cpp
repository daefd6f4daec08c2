/// palpate-load-raw: voxels without a header for the explorers.
#include "loaders/raw/raw_loader.h"

int main() { return palpate::serve_loader(*palpate::make_raw_loader()); }
