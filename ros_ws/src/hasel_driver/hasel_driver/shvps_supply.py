"""Two SHVPS boards, one for each muscle, as one supply.

Unlike the supply of `firmware/`, an SHVPS goes on when its host dies, has no latched trip, reports no ground
contact and gives one polarity only. Its STANDBY therefore means: it answered that it is switched off.
"""

import math
import time
from collections.abc import Callable
from contextlib import suppress

from hasel_driver.errors import PortError
from hasel_driver.faults import SupplyFaultError
from hasel_driver.limits import Limits, Voltages
from hasel_driver.mode import Mode
from hasel_driver.serial_port import SerialPort
from hasel_driver.shvps_channel import DIRECT_CURRENT, OFF, ShvpsChannel
from hasel_driver.supply import Capabilities, Connection, Reading, Supply


class ShvpsSupply(Supply):
    """Upper muscle on the first port, lower muscle on the second."""

    capabilities = Capabilities(deadman=False, proves_grounded=False, bipolar=False, waveforms=False)

    def __init__(
        self,
        ports: tuple[SerialPort, SerialPort],
        limits: Limits,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(limits)
        self._channels = tuple(ShvpsChannel(port) for port in ports)
        self._clock = clock
        self._rounds = (0, 0)

    def open(self, prove: bool = False) -> Connection:
        self._rounds = (0, 0)
        names = []
        try:
            for channel in self._channels:
                channel.open()
                names.append(channel.identify(self._clock, time.sleep))
                channel.send("SVset 0", f"SSwMode {OFF}")
        except (PortError, SupplyFaultError) as error:
            self.close()
            if isinstance(error, PortError):
                raise
            raise PortError(str(error)) from error
        return Connection("SHVPS " + ", ".join(names))

    def close(self) -> None:
        for channel in self._channels:
            if channel.port.fileno() is not None:
                with suppress(SupplyFaultError):
                    channel.send_at_once("SVset 0", f"SSwMode {OFF}")
            channel.port.close()

    def descriptors(self) -> list[int]:
        descriptors = [channel.port.fileno() for channel in self._channels]
        return [descriptor for descriptor in descriptors if descriptor is not None]

    def service(self, now_s: float, heartbeat: bool) -> list[Reading]:
        for channel in self._channels:
            channel.service(now_s)
        upper, lower = (channel.round for channel in self._channels)
        rounds = (upper, lower)
        if any(new <= old for new, old in zip(rounds, self._rounds, strict=True)):
            return []
        self._rounds = rounds
        return [self._reading(now_s)]

    def arm(self) -> None:
        for channel in self._channels:
            channel.send("SVset 0", f"SSwMode {DIRECT_CURRENT}")

    def disarm(self) -> None:
        for channel in self._channels:
            channel.send_at_once("SVset 0", f"SSwMode {OFF}")

    def stop(self) -> None:
        self.disarm()

    def set_voltage(self, voltage_v: Voltages) -> None:
        for channel, value in zip(self._channels, voltage_v, strict=True):
            channel.send(f"SVset {round(value)}")

    def _reading(self, now_s: float) -> Reading:
        values = [channel.values for channel in self._channels]
        commanded = (values[0]["QVset"], values[1]["QVset"])
        switched_on = any(value["QSwMode"] != OFF for value in values)
        mode = Mode.STANDBY if not switched_on else Mode.ACTIVE if any(commanded) else Mode.ARMED
        return Reading(
            time_s=now_s,
            mode=mode,
            ground=None,
            fault=None,
            commanded_v=commanded,
            measured_v=(values[0]["QVnow"], values[1]["QVnow"]),
            current_a=(math.nan, math.nan),
        )
