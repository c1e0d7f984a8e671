"""What should a user be told?

Each kind of change once, with how many things it befell, the first few by name, what it does to the light, and a way round.
"""

# So many names stand in a line.
NAMED = 4


class Notes:
    """Kinds of change in the order in which they were met, and the names of what each befell."""

    def __init__(self):
        self.kinds = {}

    def add(self, name, what, consequence):
        names = self.kinds.setdefault((what, consequence), [])
        if name not in names:
            names.append(name)

    def lines(self):
        for (what, consequence), names in self.kinds.items():
            shown = ", ".join(f"`{name}`" for name in names[:NAMED])
            more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
            yield f"{what}: {len(names)} ({shown}{more}); {consequence}"
