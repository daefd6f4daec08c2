/// palpate-load-cardiac: heart models for the explorers.
#include "loaders/cardiac/cardiac_loader.h"

int main() { return palpate::serve_loader(*palpate::make_cardiac_loader()); }
