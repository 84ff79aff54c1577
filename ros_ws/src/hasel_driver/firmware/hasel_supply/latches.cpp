#include "latches.h"

#include <avr/eeprom.h>

namespace {

uint16_t* const ADDRESS = reinterpret_cast<uint16_t*>(32);  // behind the calibrations
constexpr uint16_t NEVER_STORED = 0xFFFF;

uint16_t word(uint8_t latches) {
  return latches | static_cast<uint16_t>(static_cast<uint8_t>(~latches)) << 8;
}

}  // namespace

uint8_t load_latches() {
  const uint16_t stored = eeprom_read_word(ADDRESS);
  if (stored == NEVER_STORED) return 0;
  const uint8_t latches = stored & 0xFF;
  return stored == word(latches) ? latches : UNPROVEN | DISAGREED;
}

void store_latches(uint8_t latches) {
  eeprom_update_word(ADDRESS, word(latches));
}
