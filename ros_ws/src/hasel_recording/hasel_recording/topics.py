"""The topics of the stack and their types."""

COMMAND = "/hasel/command"
STATE = "/hasel/state"
DRIVE = "/hasel/drive"  # of bodies that other channels than the supply's two voltages drive
MEASURED = "/hasel/bending/measured"
SIMULATED = "/hasel/bending/simulated"
MARKERS = "/hasel/markers/measured"  # head, middle, tail [m] of recordings from before MEASURED had metres

TOPIC_TYPES = {
    COMMAND: "hasel_interfaces/msg/Actuation",
    STATE: "hasel_interfaces/msg/SupplyState",
    DRIVE: "hasel_interfaces/msg/DriveSignal",
    MEASURED: "hasel_interfaces/msg/BendingAngle",
    SIMULATED: "hasel_interfaces/msg/BendingAngle",
    MARKERS: "geometry_msgs/msg/PoseArray",
    "/hasel/swimmer": "visualization_msgs/msg/MarkerArray",
    "/hasel/fit": "hasel_interfaces/msg/Fit",
    "/hasel/diagnosis": "hasel_interfaces/msg/Diagnosis",
    "/hasel/error": "hasel_interfaces/msg/RunningError",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
}
