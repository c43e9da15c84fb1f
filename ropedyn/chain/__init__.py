"""A scene compiled to plain arrays that the core reads."""
