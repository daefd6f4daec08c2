/// palpate-load-nifti: NIfTI images for the explorers.
#include "loaders/nifti/nifti_loader.h"

int main() { return palpate::serve_loader(*palpate::make_nifti_loader()); }
