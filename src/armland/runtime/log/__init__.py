"""Run logs: MCAP files whose messages are ROS 2 definitions made from the message table."""

from armland.runtime.log.reading import Log, read_log

__all__ = ["Log", "read_log"]
