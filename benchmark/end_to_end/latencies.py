"""Latencies of runs of a simulator."""

from statistics import median


class Latencies:
    """`sent` and `skipped` count messages; an answer that says that there is none counts as skipped. `late` tells whether
    the sender failed to send at its rate. `query` is the node's own median of the time of a query [µs]; 0: none."""

    def __init__(self, rate, sent, skipped, late, query, microseconds):
        self.rate, self.sent, self.skipped, self.late, self.query = rate, sent, skipped, late, query
        self.microseconds = sorted(microseconds)

    @classmethod
    def of_report(cls, report):
        return cls(report['rate'], report['sent'], report['skipped'] + report['failed'], report['late'],
                   report['query'], report['latencies'])

    @classmethod
    def of_rounds(cls, rounds):
        """Several runs at one rate."""
        return cls(rounds[0].rate, sum(r.sent for r in rounds), sum(r.skipped for r in rounds),
                   any(r.late for r in rounds), median(r.query for r in rounds), [value for r in rounds for value in r.microseconds])

    def quantile(self, share):
        """What a share of all latencies, in [0, 1], does not exceed [µs]. None if there are no latencies."""
        return self.microseconds[round(share * (len(self.microseconds) - 1))] if self.microseconds else None

    def summary(self):
        return {'rate': self.rate, 'sent': self.sent, 'skipped': self.skipped, 'late': self.late, 'query': self.query,
                'median': self.quantile(0.5), 'p99': self.quantile(0.99), 'p999': self.quantile(0.999),
                'worst': self.quantile(1.0)}
