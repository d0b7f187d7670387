#pragma once

namespace hv {

/// Keeps freed memory with the process instead of giving it back after every scan: the buffers of
/// the next scan would have to be faulted in anew, which costs several milliseconds now and then.
/// To be called once, first thing in main. Does nothing where the C library has no such setting.
void KeepFreedMemory();

/// Resident memory of this process [MB]; 0 when unknown.
double ResidentMegabytes();

}  // namespace hv
