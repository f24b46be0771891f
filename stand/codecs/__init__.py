"""Codecs, one a file: bytes in, typed samples out. Each file holds one public `Codec`; `feed` is sans-IO."""
