"""The evidence that the estimate is right: studies that compute tables and figures on the public interface.

`studies` lists the studies and runs them, `page` holds tables, figures and sections and writes them, `figures` draws,
`parallel` does independent runs side by side. Each other module is one study.
"""
