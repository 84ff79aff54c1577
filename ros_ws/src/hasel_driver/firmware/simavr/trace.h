// Prints `wire`, the time and both voltages, of each SET VOLTAGE that the host sends.
#pragma once

#include <stddef.h>

void trace_commands(const char* data, size_t size, double time_s);
