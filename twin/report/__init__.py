"""Report pages: self-contained HTML."""

from twin.report.comparison import comparison_page

__all__ = ["comparison_page"]
