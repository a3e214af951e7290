// Purpose: the C++ headers' own words as Python's documentation, so that neither can say something else.
#pragma once

namespace vobench::python {

// "sim/simulator.h:Simulator::Render": the comment of that declaration; "sim/simulator.h:": the header's purpose. What
// there is, docstrings.py reads from the headers when the module is built. Throws std::logic_error for a key that there
// is none of.
const char* Doc(const char* key);

}  // namespace vobench::python
