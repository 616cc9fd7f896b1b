"""The evidence that the estimate is right: studies that compute tables and figures on the public interface.

Run from the source folder of percute: ``python -m studies``. `catalogue` lists the studies and runs them, `page` holds tables,
figures and sections and writes them, `figures` draws, `parallel` does independent runs side by side. Each other module is one study.
"""
