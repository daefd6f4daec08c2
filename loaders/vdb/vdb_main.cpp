/// palpate-load-vdb: grids of OpenVDB for the explorers.
#include "loaders/vdb/vdb_loader.h"

int main() { return palpate::serve_loader(*palpate::make_vdb_loader()); }
