// The processor kernels of the BLAS library.
#pragma once

#include <string>

namespace samara::petsc {

/// Lets OpenBLAS use the fastest of its kernels that this processor can execute. A processor newer
/// than the library gets kernels without AVX by default. Nothing changes
/// with another BLAS, where `OPENBLAS_CORETYPE` is set, and where the library's own choice is as
/// good. To be called before the first product: later ones may run in another thread.
void choose_blas_kernels();

/// The BLAS library and its kernels as text, e.g. "OpenBLAS 0.3.21, SkylakeX"; "BLAS" for a library
/// that does not tell.
std::string blas_version();

}  // namespace samara::petsc
