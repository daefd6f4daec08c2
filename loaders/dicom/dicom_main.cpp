/// palpate-load-dicom: series of DICOM images for the explorers.
#include "loaders/dicom/dicom_loader.h"

int main() { return palpate::serve_loader(*palpate::make_dicom_loader()); }
