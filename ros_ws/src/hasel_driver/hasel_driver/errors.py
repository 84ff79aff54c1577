"""What can go wrong in the driver; every message says what was found, what was expected and what to do."""


class DriverError(Exception):
    """Base class of the driver's errors."""


class ProtocolError(DriverError):
    """A line that the serial protocol does not allow."""


class LimitError(DriverError):
    """A value outside its range, or not a number."""


class PortError(DriverError):
    """A serial port that cannot be opened, or a device on it that is not the expected one."""


class PortMissingError(PortError):
    """A serial port that is not there, or not yet."""


class PortInUseError(PortError):
    """A serial port that another program has open."""


class RefusedError(DriverError):
    """A request that the present state does not allow."""
