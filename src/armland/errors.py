"""One error tree. A message says what, the value, the bound and what would have worked."""


class ArmlandError(Exception):
    """Anything armland refuses. The command line turns it into one message and exit code 2."""


class ConfigurationError(ArmlandError):
    """A scenario, a parameter or a file that cannot be used as it stands."""


class ModelError(ConfigurationError):
    """An arm or UAV description that cannot be used: missing frame, unphysical inertia, unreadable file."""


class WorkspaceError(ConfigurationError):
    """A trajectory that the arm cannot follow: too far, or beyond a joint's range."""


class MountingError(ConfigurationError):
    """What is fixed beside the tool, as a gripper, is where the tool holds the UAV."""

    def __init__(self, message: str, works: str | None) -> None:
        super().__init__(message)
        self.works = works
        """An end effector of the same arm that works, as it is asked for; None where none does."""


class LogError(ArmlandError):
    """A run log that cannot be read or written."""


class PlantError(ArmlandError):
    """The simulated world left the range in which it means anything (non-finite or exploding state)."""


class PictureError(ArmlandError):
    """A picture of the scene that cannot be drawn, mostly because there is no OpenGL library."""


class StoreError(ArmlandError):
    """A campaign's store that the disk does not take any more; what was written stays."""


class ClusterError(ArmlandError):
    """Workers of a campaign that cannot be reached or do not start."""
