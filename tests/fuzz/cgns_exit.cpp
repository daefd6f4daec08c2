// libcgns, as VTK has it, ends the process at a damaged file. A helper that ends so is answered with a line; here it is an error
// as others are.
#include <new>

extern "C" [[noreturn]] void vtkcgns_cgio_error_exit(const char*);
extern "C" [[noreturn]] void vtkcgns_cgio_error_exit(const char*) { throw std::bad_alloc(); }
