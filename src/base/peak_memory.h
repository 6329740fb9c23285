#ifndef TAPA_SRC_BASE_PEAK_MEMORY_H_
#define TAPA_SRC_BASE_PEAK_MEMORY_H_

#include <string>

namespace tapa {

// The most memory that this process has held so far, in bytes; 0 if the system
// does not tell.
double PeakMemory();

// A line about it for the end of a log, such as "Peak memory: 812 MB of 4096 MB
// that this process may use".
std::string DescribePeakMemory();

}  // namespace tapa

#endif  // TAPA_SRC_BASE_PEAK_MEMORY_H_
