import io

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer


def _rewritten(data: bytes, drop: str = "", metadata: dict[str, str | None] | None = None, **options) -> bytes:
    """The same run as another tool writes it: other chunks, compressed, schemas inside the chunks."""
    reader, stream = make_reader(io.BytesIO(data)), io.BytesIO()
    writer = Writer(stream, **options)
    writer.start()
    for record in reader.iter_metadata():
        changed = record.metadata | (metadata or {})
        writer.add_metadata(record.name, {k: v for k, v in changed.items() if v is not None})
    summary = reader.get_summary()
    for schema in summary.schemas.values():
        writer.register_schema(schema.name, schema.encoding, schema.data)
    channels = {}
    for channel in reversed(summary.channels.values()):
        if channel.topic != drop:
            channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, channel.schema_id)
    for _, channel, m in reader.iter_messages(topics=[c.topic for c in summary.channels.values() if c.id in channels]):
        writer.add_message(channels[channel.id], m.log_time, m.data, m.publish_time, m.sequence)
    writer.finish()
    return stream.getvalue()


@pytest.fixture
def rewritten():
    """A run's file as another tool writes it."""
    return _rewritten
