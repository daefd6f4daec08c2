/// palpate-load-tract: tractograms for the explorers.
#include "loaders/tract/tract_loader.h"

int main() { return palpate::serve_loader(*palpate::make_tract_loader()); }
