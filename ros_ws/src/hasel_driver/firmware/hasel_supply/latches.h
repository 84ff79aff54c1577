// What must outlive a reset, in the EEPROM: faults that only a proof, or the interlock seen open, takes away.
#pragma once

#include <stdint.h>

enum Latch : uint8_t { UNPROVEN = 1, DISAGREED = 2 };

uint8_t load_latches();  // all of them where what is stored makes no sense
void store_latches(uint8_t latches);
