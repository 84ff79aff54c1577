// What this firmware calls itself.
#pragma once

constexpr char IDENTITY[] = "hasel-supply 3.0 protocol 3";
