"""Pages that a person reads: self-contained HTML that opens offline."""
