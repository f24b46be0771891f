"""The drive: CiA 402 states, addressing back-ends, profiles as files, motion."""
