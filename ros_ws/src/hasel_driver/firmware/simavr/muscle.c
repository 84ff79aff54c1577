#include "muscle.h"

#include <math.h>

static const double LEAKAGE_OHM = 1e9;
static const double GROUND_OHM = 2e6;
static const double CURRENT_LIMIT_A = 500e-6;  // 5 W at 10 kV

void muscle_step(struct muscle* muscle, double duration_s, enum contact contact, double set_point_v) {
  double conductance = 1.0 / LEAKAGE_OHM + 1.0 / muscle->short_ohm;
  if (contact == GROUND) conductance += 1.0 / GROUND_OHM;
  const double decay = exp(-duration_s * conductance / muscle->capacitance_f);
  double voltage_v = muscle->voltage_v * decay;
  muscle->current_a = 0.0;
  if (contact == POSITIVE || contact == NEGATIVE) {
    const double sign = contact == POSITIVE ? 1.0 : -1.0;
    const double gain_ohm = (1.0 - decay) / conductance;
    const double wanted_a = (set_point_v - sign * voltage_v) / gain_ohm;
    muscle->current_a = fmin(fmax(wanted_a, 0.0), CURRENT_LIMIT_A);
    voltage_v += sign * muscle->current_a * gain_ohm;
  }
  muscle->voltage_v = voltage_v;
}
