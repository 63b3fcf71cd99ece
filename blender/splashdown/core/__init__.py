"""The parts of the extension that do not need Blender, and can be tested without it."""
