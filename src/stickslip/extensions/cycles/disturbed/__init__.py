"""How a disturbance of a run grows, for every body and law: two exact runs that differ a little, compared again and again."""
