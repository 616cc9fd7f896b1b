"""Pictures of histories, estimates and contact results, with matplotlib (the extra ``plot``)."""
