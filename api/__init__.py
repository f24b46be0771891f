"""The door: REST, live stream, dashboard, command line. No physics, no bytes."""
