"""Wires: Modbus on TCP and RTU, serial streams, the drive's position ring. No meaning, only bytes and times."""
